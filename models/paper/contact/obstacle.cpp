#include "models/paper/contact/obstacle.h"

#include <algorithm>
#include <cmath>

namespace geoprior::paper {
namespace {

/// Half the interval over which velocities are differenced (s).
constexpr double kTimeStep = 1e-5;

double radius_at(const Obstacle& obstacle, double time) {
  const auto& radii = obstacle.radii;
  if (radii.empty()) return obstacle.radius;
  if (time <= radii.front().first) return radii.front().second;
  if (time >= radii.back().first) return radii.back().second;
  std::size_t i = 0;
  while (radii[i + 1].first <= time) ++i;
  const double s = (time - radii[i].first) / (radii[i + 1].first - radii[i].first);
  return (1 - s) * radii[i].second + s * radii[i + 1].second;
}

struct Distance {
  double value;
  Eigen::Vector3d normal;
};

/// Splits x - centre into height along the axis, distance from it, and the direction of that.
struct Cylindrical {
  double height, radial;
  Eigen::Vector3d direction;
};
Cylindrical cylindrical(const Eigen::Vector3d& offset, const Eigen::Vector3d& axis) {
  Cylindrical c;
  c.height = offset.dot(axis);
  c.direction = offset - c.height * axis;
  c.radial = c.direction.norm();
  c.direction = c.radial > 0 ? Eigen::Vector3d(c.direction / c.radial) : axis.unitOrthogonal();
  return c;
}

Distance to_cylinder(const Cylindrical& c, const Eigen::Vector3d& axis, double radius,
                     double half_length) {
  const double side = c.radial - radius;
  const double cap = std::abs(c.height) - half_length;
  const Eigen::Vector3d cap_normal = c.height < 0 ? Eigen::Vector3d(-axis) : axis;
  if (half_length == 0 || (side >= cap && cap <= 0)) return {side, c.direction};
  if (side <= 0) return {cap, cap_normal};
  const double rim = std::hypot(side, cap);
  return {rim, (side * c.direction + cap * cap_normal) / rim};
}

Distance to_torus(const Cylindrical& c, const Eigen::Vector3d& axis, double radius, double tube) {
  const double side = c.radial - radius;
  const double length = std::hypot(side, c.height);
  if (length == 0) return {-tube, c.direction};
  return {length - tube, (side * c.direction + c.height * axis) / length};
}

}  // namespace

ObstacleAt::ObstacleAt(const Obstacle& obstacle, double time)
    : kind_(obstacle.kind), tube_radius_(obstacle.tube_radius), half_length_(obstacle.half_length) {
  const auto place_at = [&](double t) {
    const Keyframe key = obstacle.motion ? obstacle.motion->at(t) : Keyframe{};
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.translate(obstacle.centre + key.shift).rotate(key.turn);
    return place;
  };
  const Eigen::Isometry3d now = place_at(time);
  centre_ = now.translation();
  axis_ = now.linear() * obstacle.axis;
  radius_ = radius_at(obstacle, time);
  radius_rate_ = (radius_at(obstacle, time + kTimeStep) - radius_at(obstacle, time - kTimeStep)) /
                 (2 * kTimeStep);
  if (obstacle.motion) {
    const Eigen::Isometry3d before = place_at(time - kTimeStep), after = place_at(time + kTimeStep);
    velocity_ = (after.translation() - before.translation()) / (2 * kTimeStep);
    spin_ = (after.linear() - before.linear()) * now.linear().transpose() / (2 * kTimeStep);
  }
}

Obstacle::Contact ObstacleAt::contact(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d offset = x - centre_;
  const double length = offset.norm();
  const Eigen::Vector3d outward = length > 0 ? Eigen::Vector3d(offset / length) : axis_;
  Distance distance{0, axis_};
  Eigen::Vector3d growth = Eigen::Vector3d::Zero();
  switch (kind_) {
    case Obstacle::Kind::plane:
      distance = {offset.dot(axis_), axis_};
      break;
    case Obstacle::Kind::sphere:
      distance = {length - radius_, outward};
      growth = outward;
      break;
    case Obstacle::Kind::hollow_sphere:
      distance = {radius_ - length, -outward};
      growth = outward;
      break;
    case Obstacle::Kind::cylinder: {
      const Cylindrical c = cylindrical(offset, axis_);
      distance = to_cylinder(c, axis_, radius_, half_length_);
      growth = c.direction;
      break;
    }
    case Obstacle::Kind::torus: {
      const Cylindrical c = cylindrical(offset, axis_);
      distance = to_torus(c, axis_, radius_, tube_radius_);
      growth = c.direction;
      break;
    }
  }
  const Eigen::Vector3d surface = offset - distance.value * distance.normal;
  return {distance.value, distance.normal, velocity_ + spin_ * surface + radius_rate_ * growth};
}

Obstacle::Contact Obstacle::contact(const Eigen::Vector3d& x, double time) const {
  return ObstacleAt(*this, time).contact(x);
}

}  // namespace geoprior::paper
