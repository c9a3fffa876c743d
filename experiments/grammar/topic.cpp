#include "experiments/grammar/topic.h"

#include "experiments/grammar/derive_command.h"
#include "experiments/grammar/files/gesture_file.h"
#include "experiments/grammar/scene/scene.h"

namespace geoprior::grammar {

Topic make_topic() {
  Topic topic;
  topic.name = "grammar";
  topic.summary = "rules interpret a free gesture as what the object allows (thesis 2.2.4)";
  topic.default_scene = [] { return std::make_unique<TypedOptions<GrammarSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path& folder, std::uint64_t seed) {
    return load_grammar_scene(dynamic_cast<const TypedOptions<GrammarSceneOptions>&>(set).options,
                              folder, seed);
  };
  topic.last_parameter = [](const OptionSet& set) -> std::optional<LastParameter> {
    const auto& scene = dynamic_cast<const TypedOptions<GrammarSceneOptions>&>(set).options;
    double last = static_cast<double>(scene.edits.size());
    if (scene.gesture) last += scene.gesture->steps * scene.gesture->repeats;
    if (scene.random) last += scene.random->count;
    return LastParameter{last, "1"};
  };
  topic.methods = methods();
  topic.inputs = {"nothing"};
  topic.metrics = metrics();
  topic.diagnostics = diagnostics();
  topic.view.direction = {-0.5, -1, 0.45};
  topic.view.up = {0, 0, 1};
  topic.view.shading = FigureView::Shading::flat;
  topic.commands = {derive_command()};
  topic.files = {gesture_keys()};
  return topic;
}

}  // namespace geoprior::grammar
