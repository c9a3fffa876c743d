#include "experiments/details/drawing/surface_rays.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/geometry/planar.h"

namespace geoprior::details {
namespace {

/// The edge that a ray leaves a face by: its right and left end seen along the ray.
struct Crossing {
  int face;
  std::size_t edge;  ///< of the face, from its right to its left end
  int right, left;   ///< vertices
  Eigen::Vector2d right_at, left_at;
  double right_side, left_side;  ///< <= 0, > 0
};

}  // namespace

Eigen::Vector2d unfold_corner(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                              const Eigen::Vector3d& xa, const Eigen::Vector3d& xb,
                              const Eigen::Vector3d& xc) {
  const Eigen::Vector3d edge = xb - xa, to = xc - xa;
  const double length2 = edge.squaredNorm();
  const double along = to.dot(edge) / length2;
  const double height = std::sqrt(std::max(0.0, to.squaredNorm() / length2 - along * along));
  const Eigen::Vector2d e = b - a;
  return a + along * e + height * Eigen::Vector2d(e.y(), -e.x());
}

void SurfaceRays::start(const SurfacePoint& at, const Eigen::Vector3d& tangent) {
  // A hair inside its face: from a corner or an edge a ray would have no way out that is certain.
  const double hair = 1e-7;
  Eigen::Vector3d b = at.barycentric.cwiseMax(0.0).array() + hair;
  b /= b.sum();
  const auto& f = surface_.face[at.face];
  std::array<Eigen::Vector3d, 3> c;
  for (std::size_t k = 0; k < 3; ++k) c[k] = x_[f[k]];
  face_ = at.face;
  origin_ = b[0] * c[0] + b[1] * c[1] + b[2] * c[2];
  const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
  tangent_ = tangent - normal * normal.dot(tangent);
  if (!(tangent_.squaredNorm() > 1e-12 * tangent.squaredNorm())) tangent_ = c[1] - c[0];
  tangent_.normalize();
  const Eigen::Vector3d across = normal.cross(tangent_);
  for (std::size_t k = 0; k < 3; ++k)
    corner_[k] = {tangent_.dot(c[k] - origin_), across.dot(c[k] - origin_)};
}

void SurfaceRays::trace(const Eigen::Vector2d& ray, std::span<const double> distance,
                        std::span<Eigen::Vector3d> points) const {
  const auto& f = surface_.face[face_];
  std::array<double, 3> side;
  for (std::size_t k = 0; k < 3; ++k) side[k] = cross(ray, corner_[k]);
  std::size_t k = 0;
  while (k < 3 && !(side[k] <= 0 && side[(k + 1) % 3] > 0)) ++k;
  std::size_t next = 0;
  Eigen::Vector3d from = origin_;
  if (k < 3) {
    const std::size_t l = (k + 1) % 3;
    Crossing at{face_, k, f[k], f[l], corner_[k], corner_[l], side[k], side[l]};
    double passed = 0;
    for (int faces = 0; faces < 100000; ++faces) {
      const auto &right = x_[at.right], &left = x_[at.left];
      const double t = at.right_side / (at.right_side - at.left_side);
      const double reached = ray.dot(at.right_at + t * (at.left_at - at.right_at));
      const Eigen::Vector3d to = right + t * (left - right);
      for (; next < distance.size() && distance[next] <= reached; ++next)
        points[next] = reached > passed
                           ? from + (distance[next] - passed) / (reached - passed) * (to - from)
                           : to;
      from = to;
      passed = std::max(passed, reached);
      const int g = surface_.across[at.face][at.edge];
      if (next == distance.size() || g < 0) break;
      const auto& v = surface_.face[g];
      // The edge is left -> right in the face beyond.
      const std::size_t first = v[0] == at.left ? 0 : v[1] == at.left ? 1 : 2;
      const int corner = v[(first + 2) % 3];
      const Eigen::Vector2d u = unfold_corner(at.right_at, at.left_at, right, left, x_[corner]);
      const double s = cross(ray, u);
      if (s > 0)
        at = {g, (first + 1) % 3, at.right, corner, at.right_at, u, at.right_side, s};
      else
        at = {g, (first + 2) % 3, corner, at.left, u, at.left_at, s, at.left_side};
    }
  }
  for (; next < distance.size(); ++next) points[next] = from;
}

}  // namespace geoprior::details
