#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior {

/// One joint of a skeleton, in the rest pose and in the coordinates of the mesh (metres).
///
/// The bone of a joint runs from its head to its tail and moves with the joint. Poses need no rest
/// frames: a pose is given by the transforms that carry the rest pose to the posed one, and
/// rotations turn about `head`.
struct Joint {
  std::string name;
  int parent = -1;  ///< index of the parent, smaller than the joint's own; -1 for a root
  Eigen::Vector3d head = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> tail;  ///< absent: the joint has no bone of its own
  /// Anatomical axes: name ("flexion", "twist", …) to the unit axis about which a positive angle
  /// turns, right-handed.
  std::map<std::string, Eigen::Vector3d> axes;
  /// The joint's own axes x, y, z at rest: unit columns, not always at right angles. Only for what
  /// is said in them ("local +x"); absent where the source gives positions alone.
  std::optional<Eigen::Matrix3d> frame = std::nullopt;
};

/// Joints, parents before children.
struct Skeleton {
  std::vector<Joint> joints;

  [[nodiscard]] int size() const { return static_cast<int>(joints.size()); }
  /// Index of the joint of that name; throws Error listing the names there are.
  [[nodiscard]] int index_of(std::string_view name) const;
  /// Children of each joint, in order of index.
  [[nodiscard]] std::vector<std::vector<int>> children() const;
};

/// Throws Error (naming the joint) on a parent that does not precede its child, duplicate names or
/// a bone of no length.
void validate(const Skeleton& skeleton);

/// Skinning transforms: `[j]` carries a point attached to joint j from its rest to its posed
/// position. Identity everywhere is the rest pose. Only linear blending accepts a part that is not
/// rigid.
using Pose = std::vector<Eigen::Affine3d>;

Pose rest_pose(int joint_count);

/// A rotation of one joint about its own head, relative to its parent, in rest coordinates.
struct JointRotation {
  int joint = 0;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// Forward kinematics: T_j = T_parent * (head_j + R_j (x - head_j)). Rotations of one joint
/// multiply in order.
Pose pose_from_rotations(const Skeleton& skeleton, const std::vector<JointRotation>& rotations,
                         const Eigen::Vector3d& root_translation = Eigen::Vector3d::Zero());

/// The rigid part of an affine transform (polar decomposition of its linear part).
Eigen::Isometry3d rigid_part(const Eigen::Affine3d& transform);

}  // namespace geoprior
