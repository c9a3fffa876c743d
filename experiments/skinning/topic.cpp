#include "experiments/skinning/topic.h"

#include <algorithm>

#include "experiments/skinning/rig_command.h"
#include "experiments/skinning/scene/scene.h"
#include "experiments/skinning/scene/skeleton_file.h"

namespace geoprior::skinning {
namespace {

/// A ramp's parameter is the angle of its first joint. Other motions are in files, or end with a
/// step.
std::optional<LastParameter> last_angle(const MotionOptions& motion) {
  if (motion.kind != MotionKind::ramp) return std::nullopt;
  if (motion.joint) return LastParameter{std::max(motion.from_deg, motion.to_deg), "deg"};
  if (motion.joints.empty()) return std::nullopt;
  const JointRamp& first = motion.joints.front();
  return LastParameter{std::max(first.from_deg, first.to_deg), "deg"};
}

}  // namespace

Topic make_topic() {
  Topic topic;
  topic.name = "skinning";
  topic.summary = "a character's skin follows its skeleton (thesis 3.1)";
  topic.default_scene = [] { return std::make_unique<TypedOptions<SkinningSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path& folder,
                  std::uint64_t /*seed*/) {
    return load_skinning_scene(dynamic_cast<const TypedOptions<SkinningSceneOptions>&>(set).options,
                               folder);
  };
  topic.last_parameter = [](const OptionSet& set) {
    return last_angle(dynamic_cast<const TypedOptions<SkinningSceneOptions>&>(set).options.motion);
  };
  topic.methods = methods();
  topic.inputs = {"dual-quaternion", "linear-blend"};
  topic.metrics = metrics();
  topic.diagnostics = diagnostics();
  topic.commands = {rig_command()};
  topic.files = {skeleton_keys(), pose_keys()};
  return topic;
}

}  // namespace geoprior::skinning
