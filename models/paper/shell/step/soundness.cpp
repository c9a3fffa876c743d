#include "models/paper/shell/step/soundness.h"

#include <Eigen/Geometry>

namespace geoprior::paper {
namespace {

/// A triangle that lost this much of its area in one step has collapsed.
constexpr double kLeastAreaRatio = 1e-3;
/// An edge that grows by more than this factor in a step gives cause to look whether the step went
/// too far: paper tears long before.
constexpr double kMostGrowth = 1.5;

Eigen::Vector3d triangle_normal(const Eigen::MatrixX3d& x, const Eigen::Vector3i& t) {
  const Eigen::Vector3d a = x.row(t[0]);
  const Eigen::Vector3d b = x.row(t[1]);
  const Eigen::Vector3d c = x.row(t[2]);
  return (b - a).cross(c - a);
}

}  // namespace

bool is_sound(const ShellElements& elements, const Eigen::MatrixX3d& before,
              const Eigen::MatrixX3d& after) {
  if (!after.allFinite()) return false;
  for (int e = 0; e < elements.size(); ++e) {
    const auto nodes = elements.nodes(e);
    const Eigen::Vector3i t(nodes[0], nodes[1], nodes[2]);
    const Eigen::Vector3d old_normal = triangle_normal(before, t);
    const Eigen::Vector3d new_normal = triangle_normal(after, t);
    if (!(old_normal.dot(new_normal) > 0)) return false;
    if (!(new_normal.squaredNorm() >
          kLeastAreaRatio * kLeastAreaRatio * old_normal.squaredNorm())) {
      return false;
    }
  }
  return true;
}

bool stretches(const ShellElements& elements, const Eigen::MatrixX3d& before,
               const Eigen::MatrixX3d& after) {
  for (int e = 0; e < elements.size(); ++e) {
    const auto nodes = elements.nodes(e);
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = nodes[k], b = nodes[(k + 1) % 3];
      const double old_length = (before.row(a) - before.row(b)).norm();
      if ((after.row(a) - after.row(b)).norm() > kMostGrowth * old_length) return true;
    }
  }
  return false;
}

}  // namespace geoprior::paper
