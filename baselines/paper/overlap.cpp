#include "baselines/paper/overlap.h"

#include <algorithm>

#include "baselines/paper/planar.h"

namespace geoprior {
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
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector2d along = a[(k + 1) % 3] - a[k];
    if (cross(along, b[0] - a[k]) <= 0 && cross(along, b[1] - a[k]) <= 0 &&
        cross(along, b[2] - a[k]) <= 0) {
      return true;
    }
  }
  return false;
}

/// The part of a polygon on the left of the line through `a` along `along`
/// (Sutherland, Hodgman 1974).
Clipped left_of(const Clipped& polygon, const Vector2d& a, const Vector2d& along) {
  Clipped result;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Vector2d& p = polygon.corners[i];
    const Vector2d& q = polygon.corners[(i + 1) % polygon.count];
    const double here = cross(along, p - a), there = cross(along, q - a);
    if (here >= 0) result.add(p);
    if ((here > 0 && there < 0) || (here < 0 && there > 0)) {
      result.add(p + here / (here - there) * (q - p));
    }
  }
  return result;
}

}  // namespace

double overlap_area(const PlaneTriangle& a, const PlaneTriangle& b) {
  if (apart(a, b) || apart(b, a)) return 0;
  Clipped polygon;
  for (const Vector2d& p : b) polygon.add(p);
  for (std::size_t k = 0; k < 3 && polygon.count > 0; ++k) {
    polygon = left_of(polygon, a[k], a[(k + 1) % 3] - a[k]);
  }
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.count; ++i) {
    twice +=
        cross(polygon.corners[i] - polygon.corners[0], polygon.corners[i + 1] - polygon.corners[0]);
  }
  return std::max(0.0, twice / 2);
}

}  // namespace geoprior
