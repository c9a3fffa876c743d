#include "experiments/sound/topic.h"

#include "experiments/sound/scene/bank_cache.h"
#include "experiments/sound/scene/scene.h"

namespace geoprior::sound {
namespace {

/// White paper, as paper is drawn.
FigureView sound_view() {
  FigureView view;
  view.direction = {0.5, -1, 0.7};
  view.up = {0, 0, 1};
  view.shading = FigureView::Shading::flat;
  view.material = FigureView::Material::paper;
  view.edges = true;
  return view;
}

}  // namespace

Topic make_topic() {
  Topic topic;
  topic.name = "sound";
  topic.summary = "an animated sheet of paper is heard (thesis 3.2.3)";
  topic.default_scene = [] { return std::make_unique<TypedOptions<SoundSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path& folder, std::uint64_t seed) {
    return load_sound_scene(dynamic_cast<const TypedOptions<SoundSceneOptions>&>(set).options,
                            folder, seed);
  };
  topic.methods = methods();
  topic.inputs = {"clicks"};
  topic.metrics = metrics();
  topic.diagnostics = diagnostics();
  topic.commands = {bank_command()};
  topic.view = sound_view();
  return topic;
}

}  // namespace geoprior::sound
