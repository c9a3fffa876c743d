#include "experiments/skinning/topic.h"

#include "experiments/skinning/scene.h"

namespace geoprior {

Topic skinning_topic() {
  Topic topic;
  topic.name = "skinning";
  topic.summary = "a character's skin follows its skeleton (thesis 3.1)";
  topic.default_scene = [] { return std::make_unique<TypedOptions<SkinningSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path& folder) {
    return load_skinning_scene(dynamic_cast<const TypedOptions<SkinningSceneOptions>&>(set).options,
                               folder);
  };
  topic.methods = skinning_methods();
  topic.metrics = skinning_metrics();
  topic.diagnostics = skinning_diagnostics();
  return topic;
}

}  // namespace geoprior
