#include "experiments/skinning/scene/scene_view.h"

#include <algorithm>
#include <cmath>

namespace geoprior::skinning {
namespace {

using Eigen::Vector3d;

constexpr double kAlong = 0.9;  ///< cosine from which two directions count as one

/// Of the bones beside a joint, the longer one; of a leaf, that of its parent (m).
double longest_bone(const Skeleton& skeleton, const Joint& joint) {
  double length = joint.tail ? (*joint.tail - joint.head).norm() : 0;
  if (joint.parent >= 0) {
    length = std::max(length, (joint.head - skeleton.joints[joint.parent].head).norm());
  }
  return length;
}

double largest_radius(const std::vector<JointRegion>& regions) {
  double radius = 0;
  for (const JointRegion& region : regions)
    for (const JointRegion::Hinge& hinge : region.hinges) radius = std::max(radius, hinge.radius);
  return radius;
}

/// The unit part of a vector across an axis; zero where it lies along it.
Vector3d across(const Vector3d& v, const Vector3d& axis) {
  const Vector3d rest = v - v.dot(axis) * axis;
  return rest.norm() > 1e-6 * v.norm() ? rest.normalized() : Vector3d::Zero();
}

/// Across a bone that turns about itself: from the front, or from the side of one that points
/// there.
Vector3d beside(const Vector3d& bone) {
  const Vector3d front = Vector3d::UnitZ();
  return across(std::abs(bone.dot(front)) < kAlong ? front : Vector3d::UnitX(), bone);
}

std::array<double, 3> array_of(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

std::optional<Camera> bending_camera(const RiggedMesh& rig, const Motion& motion,
                                     const std::vector<JointRegion>& regions) {
  if (motion.turned_joints.empty() || motion.turned_axes[0].isZero()) return std::nullopt;
  const Skeleton& skeleton = rig.skeleton;
  const Joint& joint = skeleton.joints[motion.turned_joints[0]];
  const Pose& pose = motion.poses.back();
  const Eigen::Affine3d carried =
      joint.parent >= 0 ? pose[joint.parent] : Eigen::Affine3d::Identity();
  const Vector3d target = carried * joint.head;
  Vector3d direction = (carried.linear() * motion.turned_axes[0]).normalized();
  const Vector3d bone =
      joint.tail ? Vector3d((*joint.tail - joint.head).normalized()) : Vector3d::Zero();
  if (std::abs(motion.turned_axes[0].dot(bone)) > kAlong) {
    direction = beside(carried.linear() * bone);
  }
  const Vector3d middle = rig.mesh.V.colwise().mean().transpose();
  if (direction.dot(target - middle) < 0) direction = -direction;
  const bool from_above = std::abs(direction.y()) > kAlong;
  Camera camera;
  camera.target = array_of(target);
  camera.direction = array_of(direction);
  camera.up = array_of(from_above ? Vector3d::UnitZ() : Vector3d::UnitY());
  camera.height_m = std::max(1.3 * longest_bone(skeleton, joint), 6 * largest_radius(regions));
  const bool is_seen = camera.height_m > 1e-9 && camera.height_m < 1e9 && target.allFinite();
  return is_seen ? std::optional(camera) : std::nullopt;
}

}  // namespace geoprior::skinning
