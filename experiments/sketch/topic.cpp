#include "experiments/sketch/topic.h"

#include "experiments/sketch/drawing/stroke_kinds.h"
#include "experiments/sketch/scene/scene.h"
#include "experiments/sketch/sketch_command.h"

namespace geoprior::sketch {

Topic make_topic() {
  Topic topic;
  topic.name = "sketch";
  topic.summary = "developable surfaces and flat patterns from annotated drawings (thesis 2.1)";
  topic.default_scene = [] { return std::make_unique<TypedOptions<SketchSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path& folder, std::uint64_t seed) {
    return load_sketch_scene(dynamic_cast<const TypedOptions<SketchSceneOptions>&>(set).options,
                             folder, seed);
  };
  topic.methods = methods();
  topic.inputs = {"visual-hull"};
  topic.metrics = metrics();
  topic.diagnostics = diagnostics();
  topic.told_files = {"pattern-verdict.txt"};
  topic.commands = {sketch_command(make_topic)};
  topic.files = {drawing_keys(), stroke_keys()};
  topic.view.direction = {0.8, 0.5, 1};
  topic.view.up = {0, 1, 0};
  topic.view.shading = FigureView::Shading::flat;
  topic.view.overlays = {"strokes", "rims", "gaps"};
  return topic;
}

}  // namespace geoprior::sketch
