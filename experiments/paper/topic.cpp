#include "experiments/paper/topic.h"

#include "experiments/paper/metrics.h"
#include "experiments/paper/scene.h"

namespace geoprior {

Topic paper_topic() {
  Topic topic;
  topic.name = "paper";
  topic.summary = "a sheet of paper bends and crumples between handles (thesis 3.2)";
  topic.default_scene = [] { return std::make_unique<TypedOptions<PaperSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path& folder) {
    return load_paper_scene(dynamic_cast<const TypedOptions<PaperSceneOptions>&>(set).options,
                            folder);
  };
  topic.methods = paper_methods();
  topic.metrics = paper_metrics();
  topic.view.direction = {0.5, -1, 0.7};
  topic.view.up = {0, 0, 1};
  return topic;
}

}  // namespace geoprior
