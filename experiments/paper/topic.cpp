#include "experiments/paper/topic.h"

#include "experiments/paper/scene/drawn_surface.h"
#include "experiments/paper/scene/scene.h"

namespace geoprior::paper {
namespace {

/// The pieces of the hybrid coloured, on white paper; what a method does not have is not drawn.
FigureView paper_view() {
  FigureView view;
  view.direction = {0.5, -1, 0.7};
  view.up = {0, 0, 1};
  view.color_by = "kind";
  view.classes = {"flat", "cylinder", "cone"};
  view.shading = FigureView::Shading::flat;
  view.material = FigureView::Material::paper;
  view.edges = true;
  view.plain_part = DrawnSurface::kPart;
  view.overlays = {"rulings", "singular_points", "handles"};
  return view;
}

}  // namespace

Topic make_topic() {
  Topic topic;
  topic.name = "paper";
  topic.summary = "a sheet of paper bends, crumples and tears between handles (thesis 3.2)";
  topic.default_scene = [] { return std::make_unique<TypedOptions<PaperSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path& folder, std::uint64_t seed) {
    return load_paper_scene(dynamic_cast<const TypedOptions<PaperSceneOptions>&>(set).options,
                            folder, seed);
  };
  topic.last_parameter = [](const OptionSet& set) -> std::optional<LastParameter> {
    const auto& scene = dynamic_cast<const TypedOptions<PaperSceneOptions>&>(set).options;
    return LastParameter{scene.duration, "s"};
  };
  topic.methods = methods();
  topic.inputs = {"adaptive", "dense"};
  topic.metrics = metrics();
  topic.diagnostics = diagnostics();
  topic.view = paper_view();
  topic.looked_at = {DrawnSurface::kPart};
  return topic;
}

}  // namespace geoprior::paper
