// Twists a cylinder by a right angle with dual quaternions: its mid-ring keeps its radius.
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
  std::printf("mid-ring radius %.9f m\n", radius);
  return std::abs(radius - options.radius) <= 1e-6 * options.radius ? 0 : 1;
}
