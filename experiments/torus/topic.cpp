#include "experiments/torus/topic.h"

#include "experiments/torus/scene/scene.h"

namespace geoprior::torus {

Topic make_topic() {
  Topic topic;
  topic.name = "torus";
  topic.summary = "a torus is corrugated until it is isometric to a square (thesis 4)";
  topic.default_scene = [] { return std::make_unique<TypedOptions<TorusSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path&, std::uint64_t seed) {
    return load_torus_scene(dynamic_cast<const TypedOptions<TorusSceneOptions>&>(set).options,
                            seed);
  };
  topic.last_parameter = [](const OptionSet& set) -> std::optional<LastParameter> {
    const auto& scene = dynamic_cast<const TypedOptions<TorusSceneOptions>&>(set).options;
    if (scene.view && scene.view->zooms) return LastParameter{*scene.view->zooms - 1., "1"};
    return LastParameter{static_cast<double>(scene.corrugations.size()), "1"};
  };
  topic.methods = methods();
  topic.inputs = {"revolution", "single-corrugation"};
  topic.metrics = metrics();
  topic.diagnostics = diagnostics();
  topic.view.direction = {-0.6, 0, -1};
  topic.view.up = {0, 0, 1};
  return topic;
}

}  // namespace geoprior::torus
