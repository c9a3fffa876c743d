#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/inputs/skeleton.h"
#include "testbed/topic.h"

namespace geoprior::skinning {

/// A skeleton authored for a mesh, and how motion capture drives it.
///
///     [joint.knee-left]
///     parent = "hip-left"                    # absent for a root
///     head = [0.1452, 0.4630, 0.0245]        # m, in the coordinates of the mesh
///     tail = [0.1845, 0.0780, 0.0235]        # absent: no bone of its own
///     axes = { flexion = "+x", twist = [0.10, -0.99, 0.0] }   # right-handed, any length
///     bvh = "LeftLeg"                        # joint of a BVH file that drives it
///     bvh_align = false                      # take its rotation as it is (default: true)
///
/// Joints may stand in any order; they are sorted so that parents come first. Unknown keys are
/// errors.
struct SkeletonFile {
  Skeleton skeleton;
  std::vector<std::optional<std::string>> bvh_joint;  ///< for each joint
  std::vector<bool> bvh_align;                        ///< for each joint
};

/// @throws Error  naming file, line and what is allowed; unknown or cyclic parents name the joint
SkeletonFile read_skeleton_file(const std::filesystem::path& file);
SkeletonFile parse_skeleton(std::string_view text, const std::string& name);

/// The file's joints, with the frames of their namesakes in the character's own skeleton, and those
/// joints of it that are marked as kept. A kept joint, and a root of the file that has a kept
/// ancestor there, hang on their nearest ancestor that remains.
/// @param name  of the file, for messages
/// @throws Error  when that makes a joint its own ancestor
SkeletonFile with_kept_joints(const SkeletonFile& file, const Skeleton& own,
                              const std::vector<bool>& kept, const std::string& name);

/// Index of the joint of that name.
std::optional<int> find_joint(const Skeleton& skeleton, const std::string& name);

/// The keys of a skeleton file and of a pose file, for `geoprior describe`.
TopicFile skeleton_keys();
TopicFile pose_keys();

/// One angle of a pose.
struct JointAngle {
  std::string joint;
  std::string axis;
  double angle_deg = 0;
};

/// A pose of a pose file. Angles of one joint turn in the order of the file: the last is applied
/// first to a point.
struct NamedPose {
  std::string name;
  std::vector<JointAngle> angles;
};

/// Poses by joint angles, in the order of the file:
///
///     [pose.sit]
///     hip-left = { flexion = 90, abduction = 10 }    # degrees about the skeleton's named axes
///     knee-left = { flexion = 90 }
///
/// @throws Error  naming file and line
std::vector<NamedPose> read_pose_file(const std::filesystem::path& file);
std::vector<NamedPose> parse_poses(std::string_view text, const std::string& name);

/// The rotation by an angle about an axis of a joint (`joint_axis`).
/// @throws Error  when there is no such joint or axis, listing those there are
JointRotation joint_rotation(const Skeleton& skeleton, const JointAngle& angle);

/// The axis of a joint that the skeleton file names, or a literal one (literal_axis.h); unit, in
/// rest coordinates. Throws as above.
Eigen::Vector3d joint_axis(const Skeleton& skeleton, const std::string& joint,
                           const std::string& axis);

}  // namespace geoprior::skinning
