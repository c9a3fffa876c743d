#include "experiments/sketch/command/drawn_experiment.h"

#include <algorithm>

#include "core/error.h"
#include "experiments/sketch/drawing/stroke_kinds.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/options/json.h"

namespace geoprior::sketch {
namespace {

constexpr const char* kSeveralViewsHints =
    R"(# hull = { triangles = 8000 }          # a finer or coarser surface
# read = { snap = 0.02 }                # joins lines whose ends miss each other, over the view's diagonal
# align = { tolerance = 0.04 }          # views that differ in size by so much are scaled to fit
)";

constexpr const char* kSeveralViewsOptions =
    R"(# options = { suggest = { apply = 2 } }   # two seams are suggested and cut where the pattern is strained
)";

/// Ends of borders that are farther apart are not joined.
std::string one_view_options(const std::optional<double>& snap) {
  constexpr double kProposed = 0.01;
  return std::string(snap ? "" : "# ") +
         "options = { curves = { snap = " + number_text(snap.value_or(kProposed)) +
         " } }  # ends of borders are joined within so much of the drawing's diagonal\n";
}

/// Drawing over surface over pieces; the classes are those of the strokes' kinds.
std::string stroke_classes() {
  std::string list;
  for (const StrokeKindRow& row : stroke_kinds())
    list += (list.empty() ? "" : ", ") + toml_string(std::string(row.name));
  return "[" + list + "]";
}

std::string view_text(DrawnKind kind) {
  std::string text = "\n# The picture of `geoprior run`.\n[figure_view]\n";
  if (kind == DrawnKind::layers) {
    return text +
           "color_by   = \"layer\"\nidentities = true\noverlays   = [\"rims\"]\n"
           "direction  = [0.3, 0.35, 1.0]\n";
  }
  text += "color_by = \"stretch\"\nlabel    = \"Surface\"\n";
  if (kind == DrawnKind::one_view) text += "direction = [0.45, 0.25, 1.0]\n";
  text +=
      "\n[figure_view.above]\npart     = \"drawing\"\nlabel    = \"Drawing\"\n"
      "color_by = \"kind\"\nclasses  = " +
      stroke_classes() + "\n";
  text +=
      "\n[figure_view.below]\npart     = \"pattern\"\nlabel    = \"Pieces\"\n"
      "color_by = \"stretch\"\n";
  return text;
}

std::string fabrication_text(const DrawnExperiment& experiment) {
  std::string inside = experiment.kind == DrawnKind::layers ? "allowance_mm = 0, hem_mm = 0" : "";
  if (experiment.force) inside += std::string(inside.empty() ? "" : ", ") + "force = true";
  return inside.empty() ? "{}" : "{ " + inside + " }";
}

const char* method_name(DrawnKind kind) {
  switch (kind) {
    case DrawnKind::several_views:
      return "several-views";
    case DrawnKind::one_view:
      return "one-view";
    case DrawnKind::layers:
      break;
  }
  return "layers";
}

}  // namespace

DrawnKind drawn_kind(const Drawing& drawing) {
  const View* photo = drawing.find(ViewKind::photo);
  if (photo == nullptr) return DrawnKind::several_views;
  if (!strokes_of(*photo, StrokeKind::arc).empty()) return DrawnKind::layers;
  if (!strokes_of(*photo, StrokeKind::border).empty()) return DrawnKind::one_view;
  throw Error("view:photo has neither borders nor arcs", drawing.name,
              "blue borders of a surface, or purple arcs of rigid layers");
}

std::string drawn_kind_text(const Drawing& drawing) {
  switch (drawn_kind(drawing)) {
    case DrawnKind::one_view:
      return "one view";
    case DrawnKind::layers:
      return "rigid layers";
    case DrawnKind::several_views:
      break;
  }
  std::string names;
  for (const View& view : drawing.views)
    names += (names.empty() ? "" : ", ") + std::string(view_name(view.kind));
  return "several views (" + names + ")";
}

std::string experiment_text(const DrawnExperiment& experiment) {
  std::string text = "# What `" + experiment.command +
                     "` ran. Edit it, and\n#\n#   geoprior run <this file>\n#\n"
                     "# runs it again; `geoprior describe sketch` and `geoprior describe " +
                     method_name(experiment.kind) + "` list what can be set.\n";
  text += "title = " + toml_string(experiment.title) + "\ntopic = \"sketch\"\n\n[scene]\n";
  text += "drawing     = " + toml_string(experiment.drawing) + "\n";
  if (!experiment.photo.empty()) text += "photo       = " + toml_string(experiment.photo) + "\n";
  text += "fabrication = " + fabrication_text(experiment) + "\n";
  if (experiment.textured) text += "textures    = {}\n";
  if (experiment.kind == DrawnKind::several_views) text += kSeveralViewsHints;
  text += "\n[[variant]]\nname   = " + toml_string(kDrawnVariant) +
          "\nmethod = " + toml_string(method_name(experiment.kind)) + "\n";
  if (experiment.kind == DrawnKind::several_views) text += kSeveralViewsOptions;
  if (experiment.kind == DrawnKind::one_view) text += one_view_options(experiment.snap);
  return text + view_text(experiment.kind);
}

std::string path_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const std::filesystem::path whole = std::filesystem::canonical(file);
  const std::filesystem::path relative =
      whole.lexically_relative(std::filesystem::canonical(folder));
  const auto ups = std::count(relative.begin(), relative.end(), "..");
  return (relative.empty() || ups > 1 ? whole : relative).string();
}

}  // namespace geoprior::sketch
