#include "experiments/fluid/topic.h"

#include "experiments/fluid/scene/scene.h"

namespace geoprior::fluid {

Topic make_topic() {
  Topic topic;
  topic.name = "fluid";
  topic.summary = "features are cut from liquid animations and pasted into others (thesis 3.3)";
  topic.default_scene = [] { return std::make_unique<TypedOptions<FluidSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path& folder, std::uint64_t seed) {
    return load_fluid_scene(dynamic_cast<const TypedOptions<FluidSceneOptions>&>(set).options,
                            folder, seed);
  };
  topic.last_parameter = [](const OptionSet& set) -> std::optional<LastParameter> {
    const auto& scene = dynamic_cast<const TypedOptions<FluidSceneOptions>&>(set).options;
    if (!scene.tank || !scene.sequences.empty()) return std::nullopt;  // sequences have their own
    return LastParameter{scene.duration, "s"};
  };
  topic.methods = methods();
  topic.metrics = metrics();
  topic.diagnostics = diagnostics();
  topic.view.direction = {0.6, -1, 0.5};
  topic.view.up = {0, 0, 1};
  topic.view.material = FigureView::Material::water;
  return topic;
}

}  // namespace geoprior::fluid
