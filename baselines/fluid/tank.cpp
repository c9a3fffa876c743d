#include "baselines/fluid/tank.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geoprior {
namespace {

/// What turns of a trajectory turn about: where the shape's centre is at t = 0.
Eigen::Vector3d pivot_of(const LiquidShape& shape) {
  if (shape.kind != LiquidShape::Kind::mesh || shape.mesh.vertex_count() == 0) return shape.centre;
  const Eigen::Vector3d low = shape.mesh.V.colwise().minCoeff(),
                        high = shape.mesh.V.colwise().maxCoeff();
  return 0.5 * (low + high);
}

}  // namespace

int Tank::frame_count() const {
  // A duration that is a multiple of the interval but for round-off still has its last frame.
  return 1 + static_cast<int>(std::floor(duration / frame_interval + 1e-9));
}

double Tank::frame_time(int frame) const { return frame * frame_interval; }

double PlacedSolid::distance_at(const Eigen::Vector3d& x) const {
  // The inverse of a rigid placement, without forming it for every point.
  return (*distance)(placement.linear().transpose() * (x - placement.translation()));
}

Eigen::Vector3d PlacedSolid::velocity_at(const Eigen::Vector3d& x) const {
  return linear + angular.cross(x - centre);
}

PlacedSolid place_solid(const TankSolid& solid, const ShapeDistance& distance, double time,
                        double dt) {
  PlacedSolid placed;
  placed.distance = &distance;
  const Eigen::Vector3d pivot = pivot_of(solid.shape);
  placed.centre = pivot;
  if (!solid.motion) return placed;
  const Keyframe now = solid.motion->at(time);
  placed.placement =
      Eigen::Translation3d(pivot + now.shift) * now.turn * Eigen::Translation3d(-pivot);
  placed.centre = pivot + now.shift;
  if (!(dt > 0)) return placed;
  const Keyframe before = solid.motion->at(time - 0.5 * dt),
                 after = solid.motion->at(time + 0.5 * dt);
  placed.linear = (after.shift - before.shift) / dt;
  const Eigen::AngleAxisd turned(after.turn * before.turn.conjugate());
  // AngleAxis gives angles up to pi from a quaternion with w >= 0 and more otherwise.
  double angle = turned.angle();
  if (angle > std::numbers::pi) angle -= 2 * std::numbers::pi;
  placed.angular = angle / dt * turned.axis();
  return placed;
}

}  // namespace geoprior
