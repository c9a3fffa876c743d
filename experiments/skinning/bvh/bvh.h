#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/skinning/bvh/motion.h"
#include "experiments/skinning/scene/skeleton_file.h"

namespace geoprior::skinning {

/// Keywords may be written in any case and with or without blanks ("End site", "Frames:3"); names
/// of joints reach to the end of their line or to the brace. Of several roots the first is read,
/// and of rows as many as are announced: a further root, or one row too many, becomes a note.
///
/// @throws Error  naming file and line: syntax, unknown channels, a frame with too few numbers,
///                numbers that are not finite, counts beyond what the file holds
BvhMotion read_bvh(const std::filesystem::path& file);
BvhMotion parse_bvh(std::string_view text, const std::string& name);

/// Carries a motion over to a skeleton by the names in its file.
///
/// A joint j driven by joint b of the motion turns, in world coordinates, by R_j = G_b A_j: G_b is
/// the rotation of b from the file's rest pose, and A_j the smallest rotation that takes the rest
/// bone of j to the rest bone of b (an arm of an A-pose to that of a T-pose); A_j = 1 where
/// `bvh_align` is off or a bone has no direction. Other joints follow their parent. The root moves
/// by that of the motion's root, scaled by the ratio of the two leg lengths (rest height of the
/// root above the lowest joint), horizontally relative to `origin_frame`.
class BvhRetarget {
 public:
  /// @throws Error  when no joint of the skeleton names a joint of the motion, or one names a joint
  ///                that the motion does not have
  BvhRetarget(const BvhMotion& motion, const SkeletonFile& skeleton, int origin_frame);
  [[nodiscard]] Pose pose(int frame) const;

 private:
  const BvhMotion& motion_;
  const SkeletonFile& skeleton_;
  std::vector<int> driver_;  ///< joint of the motion, or -1
  std::vector<Eigen::Quaterniond> align_;
  double scale_ = 1;  ///< metres of the skeleton for one unit of the motion
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  ///< where the motion's root counts as at rest
};

}  // namespace geoprior::skinning
