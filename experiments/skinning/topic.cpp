#include "experiments/skinning/topic.h"

#include "experiments/skinning/rig_command.h"
#include "experiments/skinning/scene.h"
#include "experiments/skinning/skeleton_file.h"

namespace geoprior::skinning {

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
  topic.methods = methods();
  topic.metrics = metrics();
  topic.diagnostics = diagnostics();
  topic.commands = {rig_command()};
  topic.files = {skeleton_keys(), pose_keys()};
  return topic;
}

}  // namespace geoprior::skinning
