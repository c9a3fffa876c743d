#include "models/paper/contact/overlap.h"

#include <algorithm>

#include "core/geometry/planar.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// A convex polygon cut from a triangle by up to three half planes.
struct Clipped {
  std::array<Vector2d, 8> corners;
  std::size_t count = 0;
  void add(const Vector2d& p) { corners[count++] = p; }
};

/// True when an edge of `a` has all of `b` on its outer side.
bool apart(const PlaneTriangle& a, const PlaneTriangle& b) {
  const auto outside = [&](const Vector2d& p, const Vector2d& q) {
    const Vector2d along = q - p;
    return cross(along, b[0] - p) <= 0 && cross(along, b[1] - p) <= 0 &&
           cross(along, b[2] - p) <= 0;
  };
  return outside(a[0], a[1]) || outside(a[1], a[2]) || outside(a[2], a[0]);
}

/// The part of a polygon on the left of the line through `a` along `along`
/// (Sutherland, Hodgman 1974).
Clipped left_of(const Clipped& polygon, const Vector2d& a, const Vector2d& along) {
  Clipped result;
  if (polygon.count == 0) return result;
  const Vector2d* p = &polygon.corners[polygon.count - 1];
  double before = cross(along, *p - a);
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Vector2d& q = polygon.corners[i];
    const double here = cross(along, q - a);
    if ((before > 0 && here < 0) || (before < 0 && here > 0)) {
      result.add(*p + before / (before - here) * (q - *p));
    }
    if (here >= 0) result.add(q);
    p = &q;
    before = here;
  }
  return result;
}

}  // namespace

double overlap_area(const PlaneTriangle& a, const PlaneTriangle& b) {
  if (apart(a, b) || apart(b, a)) return 0;
  Clipped polygon;
  for (const Vector2d& p : b) polygon.add(p);
  polygon = left_of(polygon, a[0], a[1] - a[0]);
  polygon = left_of(polygon, a[1], a[2] - a[1]);
  polygon = left_of(polygon, a[2], a[0] - a[2]);
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.count; ++i) {
    twice +=
        cross(polygon.corners[i] - polygon.corners[0], polygon.corners[i + 1] - polygon.corners[0]);
  }
  return std::max(0.0, twice / 2);
}

}  // namespace geoprior::paper
