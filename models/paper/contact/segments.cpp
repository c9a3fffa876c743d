#include "models/paper/contact/segments.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/planar.h"

namespace geoprior::paper {

using Eigen::Vector2d;

double distance_to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0;
  return (p - a - t * along).norm();
}

std::optional<double> ray_hit(const Vector2d& origin, const Vector2d& direction, const Vector2d& a,
                              const Vector2d& b, double beyond) {
  const Vector2d along = b - a;
  const double det = cross(direction, along);
  if (std::abs(det) <= 1e-12 * direction.norm() * along.norm()) return std::nullopt;
  const double t = cross(a - origin, along) / det;
  const double u = cross(a - origin, direction) / det;
  if (t <= beyond || u < 0 || u > 1) return std::nullopt;
  return t;
}

double line_angle(const Vector2d& a, const Vector2d& b) {
  return std::atan2(std::abs(cross(a, b)), std::abs(a.dot(b)));
}

double ray_angle(const Vector2d& a, const Vector2d& b) {
  return std::atan2(std::abs(cross(a, b)), a.dot(b));
}

}  // namespace geoprior::paper
