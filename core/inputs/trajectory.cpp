#include "core/inputs/trajectory.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geoprior {
namespace {

/// Cubic Hermite polynomial on an interval of length `dt` at the fraction `s`.
Eigen::Vector3d hermite(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                        const Eigen::Vector3d& v0, const Eigen::Vector3d& v1, double dt, double s) {
  const double s2 = s * s, s3 = s2 * s;
  return p0 + (3 * s2 - 2 * s3) * (p1 - p0) + (s3 - 2 * s2 + s) * dt * v0 + (s3 - s2) * dt * v1;
}

/// Velocity at a key between two slopes: their mean weighted by time, zero where the coordinate
/// turns round, and at most three times the smaller slope, which keeps a cubic monotone (Fritsch
/// and Carlson 1980).
Eigen::Vector3d limited_velocity(const Eigen::Vector3d& before, double dt_before,
                                 const Eigen::Vector3d& after, double dt_after) {
  Eigen::Vector3d velocity;
  for (int c = 0; c < 3; ++c) {
    if (before[c] * after[c] <= 0) {
      velocity[c] = 0;
      continue;
    }
    const double mean = (before[c] * dt_before + after[c] * dt_after) / (dt_before + dt_after);
    const double limit = 3 * std::min(std::abs(before[c]), std::abs(after[c]));
    velocity[c] = std::clamp(mean, -limit, limit);
  }
  return velocity;
}

/// Rotation vector (axis times angle, at most pi long).
Eigen::Vector3d log_rotation(Eigen::Quaterniond q) {
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-300) return Eigen::Vector3d::Zero();
  return (2 * std::atan2(sine, q.w()) / sine) * q.vec();
}

Eigen::Quaterniond exp_rotation(const Eigen::Vector3d& r) {
  const double angle = r.norm();
  if (angle < 1e-300) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, r / angle));
}

/// Derivative of the rotation vector `r` for a body-fixed angular velocity: the inverse of the
/// right Jacobian of SO(3).
Eigen::Vector3d rotation_vector_rate(const Eigen::Vector3d& r, const Eigen::Vector3d& omega) {
  const double angle = r.norm();
  const double c =
      angle < 1e-4
          ? 1.0 / 12
          : (1 - 0.5 * angle / std::tan(0.5 * std::min(angle, std::numbers::pi))) / (angle * angle);
  return omega + 0.5 * r.cross(omega) + c * r.cross(r.cross(omega));
}

/// What an interval between two keys adds: both slopes, the rotation's in the body's frame, where a
/// turn about a fixed axis has the same components at both of its ends.
struct Interval {
  double dt = 0;
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  ///< rotation vector from key to key
};

Interval interval_of(const std::vector<Keyframe>& keys, std::size_t i) {
  Interval result;
  result.dt = keys[i + 1].time - keys[i].time;
  result.slope = (keys[i + 1].shift - keys[i].shift) / result.dt;
  result.turn = log_rotation(keys[i].turn.conjugate() * keys[i + 1].turn);
  return result;
}

struct KeyVelocity {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
};

KeyVelocity velocity_at_key(const std::vector<Keyframe>& keys, std::size_t i) {
  if (i == 0 || i + 1 == keys.size()) return {};
  const Interval a = interval_of(keys, i - 1), b = interval_of(keys, i);
  return {limited_velocity(a.slope, a.dt, b.slope, b.dt),
          limited_velocity(a.turn / a.dt, a.dt, b.turn / b.dt, b.dt)};
}

}  // namespace

Keyframe Trajectory::at(double time) const {
  if (keys.empty()) return {};
  if (time <= keys.front().time) return keys.front();
  if (time >= keys.back().time) return keys.back();
  std::size_t i = 0;
  while (keys[i + 1].time <= time) ++i;
  const Interval interval = interval_of(keys, i);
  const KeyVelocity v0 = velocity_at_key(keys, i), v1 = velocity_at_key(keys, i + 1);
  const double s = (time - keys[i].time) / interval.dt;
  Keyframe result;
  result.time = time;
  result.shift = hermite(keys[i].shift, keys[i + 1].shift, v0.shift, v1.shift, interval.dt, s);
  const Eigen::Vector3d turned =
      hermite(Eigen::Vector3d::Zero(), interval.turn, v0.turn,
              rotation_vector_rate(interval.turn, v1.turn), interval.dt, s);
  result.turn = (keys[i].turn * exp_rotation(turned)).normalized();
  return result;
}

}  // namespace geoprior
