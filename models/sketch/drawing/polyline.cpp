#include "models/sketch/drawing/polyline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/geometry/planar.h"

namespace geoprior::sketch {

BesideStroke beside(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& x) {
  BesideStroke found;
  double least = std::numeric_limits<double>::infinity(), before = 0, side = 0;
  const bool closed = points.size() > 2 && points.front() == points.back();
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector2d along = points[i + 1] - points[i];
    const double length = along.norm();
    double t = (x - points[i]).dot(along) / length;
    if (closed || i > 0) t = std::max(t, 0.0);
    if (closed || i + 2 < points.size()) t = std::min(t, length);
    const Eigen::Vector2d off = x - points[i] - t / length * along;
    const double s = cross(along, off) / length;
    // At a corner both segments are as near: the one that sees the point more from the side tells
    // which side it is.
    const double distance = off.norm();
    if (distance < least || (distance == least && std::abs(s) > std::abs(side))) {
      least = distance;
      side = s;
      found.distance = std::copysign(distance, s);
      found.along = before + t;
      found.direction = along / length;
    }
    before += length;
  }
  return found;
}

Eigen::Vector2d point_along(const std::vector<Eigen::Vector2d>& points, double along) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector2d step = points[i + 1] - points[i];
    const double length = step.norm();
    if (along <= length || i + 2 == points.size()) return points[i] + along / length * step;
    along -= length;
  }
  return points.back();
}

double length(const std::vector<Eigen::Vector2d>& points) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) sum += (points[i + 1] - points[i]).norm();
  return sum;
}

}  // namespace geoprior::sketch
