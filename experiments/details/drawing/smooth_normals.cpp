#include "experiments/details/drawing/smooth_normals.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/parallel.h"

namespace geoprior::details {
namespace {

constexpr std::size_t kNormalBlock = 1024;

Eigen::Vector3d normal_of_vertex(int v, const SurfaceTopology& surface,
                                 std::span<const Eigen::Vector3d> x) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const Eigen::Vector3d& p = x[v];
  for (const int at_v : surface.corners_of(v)) {
    const auto& c = surface.face[at_v / 3];
    const int k = at_v % 3;
    const Eigen::Vector3d a = x[c[(k + 1) % 3]] - p;
    const Eigen::Vector3d b = x[c[(k + 2) % 3]] - p;
    const Eigen::Vector3d n = a.cross(b);
    const double twice_area = n.norm();
    if (twice_area > 0) sum += std::atan2(twice_area, a.dot(b)) / twice_area * n;
  }
  return sum.stableNormalized();
}

}  // namespace

std::vector<Eigen::Vector3d> smooth_normals(const SurfaceTopology& surface,
                                            std::span<const Eigen::Vector3d> x) {
  std::vector<Eigen::Vector3d> normals(x.size());
  parallel_blocks(x.size(), kNormalBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      normals[v] = normal_of_vertex(static_cast<int>(v), surface, x);
  });
  return normals;
}

std::vector<Eigen::Vector3d> normals_at(const SurfaceTopology& surface,
                                        std::span<const Eigen::Vector3d> x,
                                        std::span<const DrawnAnchor> anchors) {
  const std::vector<Eigen::Vector3d> of_vertex = smooth_normals(surface, x);
  std::vector<Eigen::Vector3d> normals(anchors.size());
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const SurfacePoint& at = anchors[i].at;
    const auto& f = surface.face[at.face];
    Eigen::Vector3d n = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) n += at.barycentric[k] * of_vertex[f[k]];
    // The vertex normals of a knife's edge cancel.
    normals[i] = n.norm() > 1e-6 ? n.normalized() : normal_of_face(at.face, surface, x);
  }
  return normals;
}

}  // namespace geoprior::details
