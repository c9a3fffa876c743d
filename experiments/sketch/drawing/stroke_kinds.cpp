#include "experiments/sketch/drawing/stroke_kinds.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace geoprior::sketch {
namespace {

const std::array<StrokeKindRow, 9>& kind_table() {
  static const std::array<StrokeKindRow, 9> table{{
      {StrokeKind::silhouette,
       "silhouette",
       "black",
       {{0, 0, 0}},
       false,
       "outline of the shape; closed, one stroke or several end to end"},
      {StrokeKind::border, "border", "blue", {{0, 0, 255}}, false, "edge of an open surface"},
      {StrokeKind::seam, "seam", "red", {{255, 0, 0}}, false, "where two panels are sewn together"},
      {StrokeKind::fold,
       "fold",
       "green",
       {{0, 128, 0}, {0, 255, 0}},
       false,
       "contour of a fold: the surface has a constant angle to the view there"},
      {StrokeKind::symmetric_pair,
       "symmetric-pair",
       "magenta",
       {{255, 0, 255}},
       false,
       "straight line from a point to its mirror image, named pair-1, pair-2 and so on"},
      {StrokeKind::plane_vector,
       "plane-vector",
       "orange",
       {{255, 165, 0}, {255, 102, 0}},
       false,
       "straight line named sym-a or sym-b: image of two orthogonal vectors of the mirror plane"},
      {StrokeKind::occlusion,
       "occlusion",
       "grey, dashed",
       {{128, 128, 128}, {179, 179, 179}},
       true,
       "part of a curve that something hides"},
      {StrokeKind::ruling,
       "ruling",
       "cyan",
       {{0, 255, 255}},
       false,
       "straight line that lies on the surface"},
      {StrokeKind::arc, "arc", "purple", {{128, 0, 128}}, false, "circular edge of a rigid layer"},
  }};
  return table;
}

bool is_near(const SvgColour& a, const SvgColour& b) {
  constexpr int kNear = 48;
  return std::abs(a.red - b.red) <= kNear && std::abs(a.green - b.green) <= kNear &&
         std::abs(a.blue - b.blue) <= kNear;
}

}  // namespace

std::span<const StrokeKindRow> stroke_kinds() { return kind_table(); }

const StrokeKindRow& row_of(StrokeKind kind) {
  return kind_table()[static_cast<std::size_t>(kind)];
}

std::optional<StrokeKind> kind_of_name(std::string_view name) {
  for (const StrokeKindRow& row : kind_table()) {
    if (row.name == name) return row.kind;
  }
  return std::nullopt;
}

std::optional<StrokeKind> kind_of_colour(const SvgColour& colour, bool dashed) {
  for (const StrokeKindRow& row : kind_table()) {
    const bool has_colour =
        std::any_of(row.colours.begin(), row.colours.end(),
                    [&](const SvgColour& known) { return is_near(known, colour); });
    if (has_colour && (dashed || !row.dashed)) return row.kind;
  }
  return std::nullopt;
}

std::string stroke_kind_names() {
  std::string list;
  for (const StrokeKindRow& row : kind_table())
    list += (list.empty() ? "" : ", ") + std::string(row.name);
  return list;
}

std::string stroke_kind_colours() {
  std::string list;
  for (const StrokeKindRow& row : kind_table())
    list += (list.empty() ? "" : "; ") + std::string(row.name) + " " + std::string(row.colour);
  return list;
}

TopicFile drawing_keys() {
  TopicFile file{"drawing",
                 "annotated views of one object (SVG): what each stroke means is said by its "
                 "attribute data-kind, else its class, else its colour",
                 "layers view:front, view:side, view:top, view:photo",
                 {}};
  for (const StrokeKindRow& row : kind_table()) {
    file.keys.push_back({std::string(row.name), "stroke", "", std::string(row.colour), "",
                         std::string(row.meaning)});
  }
  const std::vector<OptionRow> attributes{
      {"data-kind", "text", "", stroke_kind_names() + ", none", "",
       "kind of a stroke, or of a group of them; none: a guide line that is left out"},
      {"data-name", "text", "", "", "",
       "name of a pair, a plane vector or a layer; else label, or id; of a layer else the name of "
       "the "
       "drawing program's layer that it is alone in"},
      {"data-panel", "text", "", "", "",
       "panel that a seam, fold, border or ruling belongs to; of a pair that of its border; "
       "several "
       "joined by +"},
      {"data-depth", "text", "front", "front, back, both", "",
       "side of the object on which a line inside of the silhouette lies"},
      {"data-border", "text", "silhouette", "silhouette, inside", "",
       "where a border runs: along the silhouette, which opens the end there; or inside of it, "
       "where an "
       "open "
       "line is a slit and a closed one a hole"},
      {"data-fold-angle", "number", "", "0 to 90", "deg",
       "angle between normal and view direction; absent: the method's"},
      {"data-fold-width", "length", "", "more than 0", "mm",
       "width of the bent strip in true size, with or without a unit; absent: the method's"},
      {"data-fold-side", "text", "", "left, right", "",
       "side of the stroke, along it, to which the surface falls away from the eye; absent: the "
       "one "
       "that turns it less"},
      {"data-scale", "number", "1", "", "",
       "scale of the outermost svg: 10 or 1:10 for a drawing at a tenth of true size"}};
  file.keys.insert(file.keys.end(), attributes.begin(), attributes.end());
  return file;
}

}  // namespace geoprior::sketch
