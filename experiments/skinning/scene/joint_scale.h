#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/inputs/rig.h"

namespace geoprior::skinning {

/// What becomes of a clip that scales joints. Linear blend follows a scale; dual quaternions,
/// centres of rotation and the methods that start from them turn and move only, each losing the
/// scale in its own way, so that numbers of a comparison would not be of one motion.
enum class JointScale { refuse, strip };

/// The scale of a joint that is farthest from 1: a singular value of its transform's linear part.
struct ScaledJoint {
  int joint = 0;
  std::size_t frame = 0;
  double factor = 1;
};

/// The joint that is scaled most in some frame, of those that carry weight; absent where all keep
/// their size within a thousandth.
std::optional<ScaledJoint> most_scaled_joint(const std::vector<Pose>& poses, const RiggedMesh& rig);

/// A joint of which a frame leaves nothing, or nothing that is finite.
struct LostJoint {
  int joint = 0;
  std::size_t frame = 0;
  bool is_finite = true;  ///< scaled to zero in some direction
};

/// The first frame and the topmost joint that is lost, of those that move skin, themselves or by a
/// joint below them.
std::optional<LostJoint> lost_joint(const std::vector<Pose>& poses, const RiggedMesh& rig);

/// @throws Error  always, naming the joint
/// @param what  "the clip 'walk'"
/// @param when  " at 1 s", or nothing
[[noreturn]] void refuse_lost(const std::string& what, const LostJoint& lost,
                              const Skeleton& skeleton, const std::string& when,
                              const std::string& file);

/// "scales joint 'B' by 2 at 1 s".
std::string scale_text(const ScaledJoint& scaled, const Skeleton& skeleton,
                       const std::vector<double>& times_s);

/// @throws Error  always: why such a clip is no comparison, and how it can be played
[[noreturn]] void refuse_scale(const std::string& what, const std::string& file);

/// Makes every transform rigid (polar decomposition); the heads of the joints stay where they are.
void make_rigid(const Skeleton& skeleton, Pose& pose);

}  // namespace geoprior::skinning
