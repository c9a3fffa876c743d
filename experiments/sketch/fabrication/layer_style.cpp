#include "experiments/sketch/fabrication/layer_style.h"

#include <charconv>

#include "core/error.h"

namespace geoprior::sketch {

const std::string& LayerStyle::colour(SheetLayer layer) const {
  switch (layer) {
    case SheetLayer::cut:
      return cut;
    case SheetLayer::sew:
      return sew;
    case SheetLayer::fold:
      return fold;
    case SheetLayer::notch:
      return notch;
    case SheetLayer::grain:
      return grain;
    case SheetLayer::drill:
      return drill;
    case SheetLayer::place:
      return place;
    case SheetLayer::text:
      break;
  }
  return text;
}

void describe(OptionVisitor& v, LayerStyle& style) {
  v.value("cut", style.cut, {.doc = "colour of cutting lines, #rrggbb"});
  v.value("sew", style.sew, {.doc = "colour of sewing lines"});
  v.value("fold", style.fold, {.doc = "colour of fold lines"});
  v.value("notch", style.notch, {.doc = "colour of notches"});
  v.value("grain", style.grain, {.doc = "colour of grain arrows"});
  v.value("text", style.text, {.doc = "colour of text, scale bar and marks"});
  v.value("drill", style.drill, {.doc = "colour of holes"});
  v.value("place", style.place, {.doc = "colour of lines where the edge of another piece lies"});
  v.value("line_mm", style.line_mm, {.doc = "width of lines", .unit = "mm", .min = 0.01, .max = 5});
}

std::array<double, 3> layer_rgb(const LayerStyle& style, SheetLayer layer) {
  const std::string& text = style.colour(layer);
  int value = 0;
  const char* end = text.data() + text.size();
  const bool fits = text.size() == 7 && text[0] == '#' && text[1] != '-';
  if (!fits || std::from_chars(text.data() + 1, end, value, 16).ptr != end) {
    throw Error("'" + text + "' is no colour", "layer " + std::string(layer_name(layer)),
                "#rrggbb with hexadecimal digits");
  }
  return {(value >> 16) / 255.0, ((value >> 8) & 0xFF) / 255.0, (value & 0xFF) / 255.0};
}

}  // namespace geoprior::sketch
