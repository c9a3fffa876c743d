#pragma once

#include <array>
#include <string>

#include "core/options.h"
#include "experiments/sketch/pattern/sheet.h"

namespace geoprior::sketch {

/// Colours by which laser cutters tell what to do along a line, as "#rrggbb", and the pen.
struct LayerStyle {
  std::string cut = "#ff0000";
  std::string sew = "#0000ff";
  std::string fold = "#008000";
  std::string notch = "#ff00ff";
  std::string grain = "#808080";
  std::string text = "#000000";
  std::string drill = "#ff8000";
  std::string place = "#00a0a0";
  double line_mm = 0.25;

  [[nodiscard]] const std::string& colour(SheetLayer layer) const;
};

/// One description for parsing, validation and help.
void describe(OptionVisitor& v, LayerStyle& style);

/// Red, green and blue in [0, 1].
///
/// @throws Error  naming the layer, unless its colour is "#rrggbb"
std::array<double, 3> layer_rgb(const LayerStyle& style, SheetLayer layer);

/// Height of the middle of capital letters above the base line, in units of the font's size.
inline constexpr double kCapitalMiddle = 0.36;

}  // namespace geoprior::sketch
