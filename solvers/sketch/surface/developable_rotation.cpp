#include "solvers/sketch/surface/developable_rotation.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "core/angles.h"
#include "core/connectivity.h"
#include "core/parallel.h"

namespace geoprior::sketch {
namespace {

constexpr std::array<std::string_view, 3> kFits{"literal", "guarded", "great-circle"};
constexpr double kFlat = 1e-10;

/// Triangles within so many rings of each, ascending.
void triangle_rings(const Eigen::MatrixX3i& F, int vertex_count, int rings, std::vector<int>& begin,
                    std::vector<int>& neighbour) {
  const VertexCorners corners(F, vertex_count);
  begin.assign(1, 0);
  std::vector<int> seen(F.rows(), -1), found;
  for (int t = 0; t < F.rows(); ++t) {
    found.assign(1, t);
    seen[t] = t;
    std::size_t first = 0;
    for (int ring = 0; ring < rings; ++ring) {
      const std::size_t last = found.size();
      for (std::size_t i = first; i < last; ++i) {
        for (int k = 0; k < 3; ++k) {
          for (const int corner : corners.of(F(found[i], k))) {
            if (seen[corner / 3] == t) continue;
            seen[corner / 3] = t;
            found.push_back(corner / 3);
          }
        }
      }
      first = last;
    }
    std::sort(found.begin(), found.end());
    neighbour.insert(neighbour.end(), found.begin(), found.end());
    begin.push_back(static_cast<int>(neighbour.size()));
  }
}

/// Turns `n` about A x n by a share of what its angle with A is off from `angle`.
Eigen::Matrix3d turned_to(const Eigen::Vector3d& n, const Eigen::Vector3d& A, double angle,
                          double share) {
  const Eigen::Vector3d about = A.cross(n);
  const double sine = about.norm();
  if (sine < 1e-8) return Eigen::Matrix3d::Identity();
  const double now = std::atan2(sine, A.dot(n));
  return Eigen::AngleAxisd(share * (angle - now), about / sine).toRotationMatrix();
}

}  // namespace

void describe(OptionVisitor& v, DevelopableRotationOptions& o) {
  describe_choice(v, "fit", o.fit, kFits, {.doc = "how the axis A of a cone is chosen (eq. 2.1)"});
  v.value("guard_deg", o.guard_deg,
          {.doc = "smallest angle between axis and mean normal of a guarded fit",
           .unit = "deg",
           .min = 0,
           .max = 90});
  v.value("rings", o.rings,
          {.doc = "rings of triangles that a cone is fitted to", .min = 1, .max = 8});
  v.value("relaxation", o.relaxation,
          {.doc = "share of the turn to the cone that is made", .min = 0.01, .max = 3});
}

DevelopableRotation::DevelopableRotation(const Eigen::MatrixX3i& F, int vertex_count,
                                         const DevelopableRotationOptions& options)
    : options_(options) {
  triangle_rings(F, vertex_count, options.rings, begin_, neighbour_);
}

Eigen::Matrix3d DevelopableRotation::rotation(int triangle, const Eigen::MatrixX3d& normals) const {
  const Eigen::Vector3d n = normals.row(triangle).transpose();
  const int begin = begin_[triangle], end = begin_[triangle + 1];
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int k = begin; k < end; ++k) mean += normals.row(neighbour_[k]).transpose();
  const bool great_circle = options_.fit == ConeFit::great_circle;
  const Eigen::Vector3d centre =
      great_circle ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(mean / (end - begin));
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (int k = begin; k < end; ++k) {
    const Eigen::Vector3d d = normals.row(neighbour_[k]).transpose() - centre;
    spread += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(spread);
  if (eigen.eigenvalues()[great_circle ? 1 : 2] < kFlat) return Eigen::Matrix3d::Identity();
  int chosen = 0;
  if (options_.fit == ConeFit::guarded) {
    const double most = std::cos(options_.guard_deg * kDegree) * mean.norm();
    while (chosen < 2 && std::abs(eigen.eigenvectors().col(chosen).dot(mean)) > most) ++chosen;
  }
  Eigen::Vector3d A = eigen.eigenvectors().col(chosen);
  if (great_circle) return turned_to(n, A, std::acos(0.0), options_.relaxation);
  if (A.dot(mean) < 0) A = -A;
  double angle = 0;
  for (int k = begin; k < end; ++k)
    angle += std::acos(std::clamp(normals.row(neighbour_[k]).dot(A), -1.0, 1.0));
  return turned_to(n, A, angle / (end - begin), options_.relaxation);
}

std::vector<Eigen::Matrix3d> DevelopableRotation::rotations(const Eigen::MatrixX3d& normals) const {
  std::vector<Eigen::Matrix3d> result(normals.rows());
  parallel_blocks(result.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) result[t] = rotation(static_cast<int>(t), normals);
  });
  return result;
}

}  // namespace geoprior::sketch
