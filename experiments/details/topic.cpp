#include "experiments/details/topic.h"

#include "experiments/details/scene/scene.h"

namespace geoprior::details {

Topic make_topic() {
  Topic topic;
  topic.name = "details";
  topic.summary = "details on a surface keep their spacing while it is deformed (thesis 2.2.2)";
  topic.default_scene = [] { return std::make_unique<TypedOptions<DetailSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path& folder, std::uint64_t seed) {
    return load_details_scene(dynamic_cast<const TypedOptions<DetailSceneOptions>&>(set).options,
                              folder, seed);
  };
  topic.last_parameter = [](const OptionSet& set) -> std::optional<LastParameter> {
    const auto& motion = dynamic_cast<const TypedOptions<DetailSceneOptions>&>(set).options.motion;
    if (motion.sequence) return std::nullopt;
    return LastParameter{motion.duration, "s"};
  };
  topic.methods = methods();
  topic.inputs = {"naive-stretch"};
  topic.metrics = metrics();
  topic.diagnostics = diagnostics();
  topic.view.direction = {0, 0, 1};
  topic.view.up = {0, 1, 0};
  topic.view.overlays = {"details"};
  return topic;
}

}  // namespace geoprior::details
