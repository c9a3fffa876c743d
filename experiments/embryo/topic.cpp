#include "experiments/embryo/topic.h"

#include <algorithm>

#include "experiments/embryo/frames/recorded.h"
#include "experiments/embryo/query_command.h"
#include "experiments/embryo/scene/scene.h"

namespace geoprior::embryo {

Topic make_topic() {
  Topic topic;
  topic.name = "embryo";
  topic.summary =
      "an ontology of the embryo, asked for a day and a disease, is the model (thesis 2.3)";
  topic.default_scene = [] { return std::make_unique<TypedOptions<EmbryoSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path& folder, std::uint64_t) {
    return load_embryo_scene(dynamic_cast<const TypedOptions<EmbryoSceneOptions>&>(set).options,
                             folder);
  };
  topic.last_parameter = [](const OptionSet& set) -> std::optional<LastParameter> {
    const auto& scene = dynamic_cast<const TypedOptions<EmbryoSceneOptions>&>(set).options;
    if (!scene.days.empty())
      return LastParameter{*std::max_element(scene.days.begin(), scene.days.end()), "d"};
    if (scene.to_day) return LastParameter{*scene.to_day, "d"};
    return std::nullopt;
  };
  topic.methods = methods();
  topic.inputs = {"keyframes"};
  topic.metrics = metrics();
  topic.diagnostics = diagnostics();
  topic.view.part = recorded::kSurface;
  topic.view.color_by = recorded::kKind;
  topic.view.labels = recorded::kStructure;
  topic.view.across = FigureView::Across::states;
  topic.view.direction = {0.25, -1, 0.1};
  topic.view.up = {0, 0, 1};
  topic.commands = {query_command()};
  topic.files = {expected_keys()};
  return topic;
}

}  // namespace geoprior::embryo
