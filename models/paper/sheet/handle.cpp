#include "models/paper/sheet/handle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "models/paper/contact/segments.h"

namespace geoprior::paper {

std::vector<Eigen::Vector2d> Handle::anchors() const {
  if (segment) return {segment->first, segment->second};
  if (!disc_radius || points.empty()) return points;
  // The centre alone would not carry the orientation of the patch.
  std::vector<Eigen::Vector2d> result{points.front()};
  for (int i = 0; i < kDiscAnchors; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDiscAnchors;
    result.push_back(points.front() +
                     *disc_radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return result;
}

bool Handle::covers(const Eigen::Vector2d& p, double tolerance) const {
  return distance(p) <= tolerance;
}

double Handle::distance(const Eigen::Vector2d& p) const {
  if (segment) return distance_to_segment(p, segment->first, segment->second);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& point : points) nearest = std::min(nearest, (p - point).norm());
  return disc_radius ? std::max(0.0, nearest - *disc_radius) : nearest;
}

bool Handle::is_active(double time) const {
  // Sums of steps reach an end only up to round-off.
  constexpr double kSlack = 1e-9;
  return active.empty() || std::any_of(active.begin(), active.end(), [&](const auto& interval) {
           return time >= interval.first - kSlack && time <= interval.second + kSlack;
         });
}

Eigen::Vector3d Handle::target(const Eigen::Vector3d& rest, const Eigen::Vector3d& centre,
                               double time) const {
  if (!motion) return rest;
  const Keyframe key = motion->at(time);
  return centre + key.shift + key.turn * (rest - centre);
}

}  // namespace geoprior::paper
