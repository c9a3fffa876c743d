#include "metrics/contact/intersection_depth.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "metrics/contact/self_contact.h"

namespace geoprior {
namespace {

/// Shortest way along the normal of `fixed` that takes `other` to one side of its plane.
double way_out(const Eigen::MatrixX3d& V, const Eigen::RowVector3i& fixed,
               const Eigen::RowVector3i& other) {
  const Eigen::Vector3d a = V.row(fixed(0)).transpose();
  const Eigen::Vector3d u = V.row(fixed(1)).transpose() - a;
  const Eigen::Vector3d v = V.row(fixed(2)).transpose() - a;
  const Eigen::Vector3d normal = u.cross(v).normalized();
  double above = 0;
  double below = 0;
  for (int k = 0; k < 3; ++k) {
    const double height = normal.dot(V.row(other(k)).transpose() - a);
    above = std::max(above, height);
    below = std::max(below, -height);
  }
  return std::min(above, below);
}

}  // namespace

double intersection_depth(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                          const std::vector<std::array<int, 2>>& pairs) {
  double deepest = 0;
  for (const auto& [a, b] : pairs) {
    deepest =
        std::max(deepest, std::min(way_out(V, F.row(a), F.row(b)), way_out(V, F.row(b), F.row(a))));
  }
  return deepest;
}

double intersection_depth(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F) {
  return intersection_depth(V, F, intersecting_triangles(V, F));
}

}  // namespace geoprior
