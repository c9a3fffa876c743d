#include "metrics/arrangement/crossings.h"

#include <algorithm>

#include "metrics/volume/box_grid.h"

namespace geoprior {
namespace {

PlanarBox plan_box(const ThickSegment& s) {
  const Eigen::Vector2d a = s.a.head<2>(), b = s.b.head<2>();
  return {a.cwiseMin(b).array() - s.radius, a.cwiseMax(b).array() + s.radius};
}

bool heights_overlap(const ThickSegment& s, const ThickSegment& t) {
  return std::min(s.a.z(), s.b.z()) - s.radius <= std::max(t.a.z(), t.b.z()) + t.radius &&
         std::min(t.a.z(), t.b.z()) - t.radius <= std::max(s.a.z(), s.b.z()) + s.radius;
}

}  // namespace

double axes_distance(const ThickSegment& first, const ThickSegment& second) {
  const Eigen::Vector3d u = first.b - first.a, v = second.b - second.a, w = first.a - second.a;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const double uw = u.dot(w), vw = v.dot(w);
  const auto clamped = [](double x) { return std::clamp(x, 0.0, 1.0); };
  // Places s on the first and t on the second, 0 to 1: the nearest of the lines, then, where t has
  // to be clamped, the nearest of the first segment to that end.
  double s = 0, t = 0;
  if (uu > 0 && vv > 0) {
    const double sine = uu * vv - uv * uv;
    // Parallel lines are as far apart everywhere.
    if (sine > 1e-14 * uu * vv) s = clamped((uv * vw - uw * vv) / sine);
    t = (uv * s + vw) / vv;
    if (t < 0 || t > 1) {
      t = clamped(t);
      s = clamped((uv * t - uw) / uu);
    }
  } else if (uu > 0) {
    s = clamped(-uw / uu);
  } else if (vv > 0) {
    t = clamped(vw / vv);
  }
  return (w + s * u - t * v).norm();
}

std::vector<std::pair<int, int>> crossings(
    std::span<const ThickSegment> segments, double tolerance,
    const std::function<bool(int lower, int higher)>& may_cross) {
  std::vector<std::pair<int, int>> out;
  if (segments.empty()) return out;
  std::vector<PlanarBox> boxes;
  for (const ThickSegment& s : segments) boxes.push_back(plan_box(s));
  const BoxGrid grid(std::move(boxes));
  const int count = static_cast<int>(segments.size());
  for (int i = 0; i < count; ++i) {
    const ThickSegment& s = segments[i];
    grid.visit(grid.box(i), [&](int j) {
      const ThickSegment& t = segments[j];
      if (j <= i || !heights_overlap(s, t) || (may_cross && may_cross(i, j))) return;
      if (axes_distance(s, t) < s.radius + t.radius - tolerance) out.emplace_back(i, j);
    });
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace geoprior
