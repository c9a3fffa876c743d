#include "models/grammar/objects/crossing.h"

#include <algorithm>
#include <bit>

#include "core/error.h"

namespace geoprior::grammar {

AxisPoints closest_axis_points(const Capsule& first, const Capsule& second) {
  const Eigen::Vector3d u = first.b - first.a, v = second.b - second.a, w = first.a - second.a;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const double uw = u.dot(w), vw = v.dot(w);
  const auto clamped = [](double x) { return std::clamp(x, 0.0, 1.0); };
  double s = 0, t = 0;
  if (uu > 0 && vv > 0) {
    const double sine = uu * vv - uv * uv;
    if (sine > 1e-12 * uu * vv) s = clamped((uv * vw - uw * vv) / sine);
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
  return {first.a + s * u, second.a + t * v};
}

double gap(const Capsule& first, const Capsule& second) {
  const AxisPoints p = closest_axis_points(first, second);
  return (p.first - p.second).norm() - first.radius - second.radius;
}

void CapsuleGrid::restart(double cell, int expected) {
  if (!(cell > 0)) throw Error("the edge of a cube is not positive", "grid of capsules", "> 0 m");
  const auto count = static_cast<std::size_t>(std::max(expected, 0));
  cell_ = cell;
  heads_.assign(std::bit_ceil(std::max<std::size_t>(64, 4 * count)), -1);
  entries_.clear();
  capsules_.clear();
  current_.clear();
  entries_.reserve(8 * count);
  capsules_.reserve(2 * count);
  current_.reserve(count);
}

void CapsuleGrid::place(int owner, const Capsule& capsule) {
  if (owner >= static_cast<int>(current_.size())) current_.resize(owner + 1, -1);
  const int number = static_cast<int>(capsules_.size());
  current_[owner] = number;
  capsules_.push_back({capsule, owner});
  for_each_cell(capsule, [&](const Cell& cell) {
    int& head = heads_[bucket(cell)];
    entries_.push_back({cell, number, head});
    head = static_cast<int>(entries_.size()) - 1;
  });
}

void CapsuleGrid::remove(int owner) {
  if (owner < static_cast<int>(current_.size())) current_[owner] = -1;
}

void CapsuleGrid::take_deeper(const Capsule& capsule, const Capsule& other, int owner,
                              std::optional<Crossing>& out) {
  const AxisPoints p = closest_axis_points(capsule, other);
  const Eigen::Vector3d away = p.first - p.second;
  const double distance = away.norm();
  const double depth = capsule.radius + other.radius - distance;
  if (depth <= 0 || (out && depth <= out->depth)) return;
  // Axes that meet have no direction away from each other; any one across will do.
  const Eigen::Vector3d unit =
      distance > 1e-12 ? Eigen::Vector3d(away / distance) : (other.b - other.a).unitOrthogonal();
  out = Crossing{owner, depth, p.first, unit};
}

}  // namespace geoprior::grammar
