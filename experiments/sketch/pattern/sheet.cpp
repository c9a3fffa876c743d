#include "experiments/sketch/pattern/sheet.h"

#include <algorithm>

namespace geoprior::sketch {

std::string_view layer_name(SheetLayer layer) {
  static constexpr std::array<std::string_view, 8> kNames{"cut",   "sew",  "fold",  "notch",
                                                          "grain", "text", "drill", "place"};
  return kNames[static_cast<std::size_t>(layer)];
}

std::vector<SheetLayer> used_layers(const PatternSheet& sheet) {
  std::vector<SheetLayer> used;
  for (const SheetLayer layer : kSheetLayers) {
    const bool optional = layer == SheetLayer::drill || layer == SheetLayer::place;
    const auto has_line = [&](const SheetPiece& piece) {
      return std::any_of(piece.lines.begin(), piece.lines.end(),
                         [&](const SheetLine& line) { return line.layer == layer; });
    };
    if (!optional || std::any_of(sheet.pieces.begin(), sheet.pieces.end(), has_line))
      used.push_back(layer);
  }
  return used;
}

void describe(OptionVisitor& v, SheetOptions& o) {
  v.value(
      "allowance_mm", o.allowance_mm,
      {.doc = "seam allowance outside edges that are sewn", .unit = "mm", .min = 0, .max = 200});
  v.value("hem_mm", o.hem_mm,
          {.doc = "allowance outside free edges", .unit = "mm", .min = 0, .max = 200});
  v.value("miter_limit", o.miter_limit,
          {.doc = "how far corners of the allowance reach, in allowances", .min = 1, .max = 20});
  v.value("notch_spacing_mm", o.notch_spacing_mm,
          {.doc = "distance of notches along a seam, about", .unit = "mm", .min = 5, .max = 1e5});
  v.value("notch_length_mm", o.notch_length_mm,
          {.doc = "length of a notch's tick", .unit = "mm", .min = 0.5, .max = 20});
  v.value("text_mm", o.text_mm,
          {.doc = "height of pieces' names", .unit = "mm", .min = 2, .max = 100});
  v.value("gap_mm", o.gap_mm,
          {.doc = "distance between pieces and to the edge of the sheet",
           .unit = "mm",
           .min = 1,
           .max = 100});
  v.value("width_mm", o.width_mm,
          {.doc = "width of the sheet at least; 0: as the pieces need",
           .unit = "mm",
           .min = 0,
           .max = 1e5});
  v.value("title", o.title, {.doc = "title that is written above the scale bar"});
}

}  // namespace geoprior::sketch
