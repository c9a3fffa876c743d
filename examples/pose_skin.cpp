// Poses a skin: a cylinder of two bones is twisted by a right angle.
//
// Shows dual quaternion skinning, which keeps the radius of the middle ring where linear blending
// shrinks it by cos(angle / 2):
//   v' = q(v) / |q(v)| applied to v,   q(v) = sum_j w_j(v) q_j,   q_j the unit dual quaternion of
//   joint j.
//
//   build/release/examples/pose_skin
#include <cmath>
#include <cstdio>
#include <numbers>

#include "baselines/skinning/dual_quaternion/dual_quaternion.h"
#include "core/geometry/procedural.h"

int main() {
  const geoprior::CylinderOptions options;
  const geoprior::RiggedMesh rig = geoprior::two_bone_cylinder(options);
  const Eigen::AngleAxisd twist(std::numbers::pi / 2, rig.skeleton.joints[1].axes.at("twist"));

  Eigen::MatrixX3d posed;
  geoprior::skinning::DualQuaternionBlend(rig).deform(
      geoprior::pose_from_rotations(rig.skeleton, {{1, Eigen::Quaterniond(twist)}}), posed);

  const double radius = posed.row(geoprior::mid_ring(options).front()).norm();
  std::printf("radius of the middle ring %.9f m, at rest %.9f m\n", radius, options.radius);
  return std::abs(radius - options.radius) <= 1e-6 * options.radius ? 0 : 1;
}
