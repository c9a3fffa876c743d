#pragma once

#include <string>
#include <string_view>

namespace geoprior {

/// A pixel of CSS and SVG 2 (m): a 96th of an inch. Inkscape before 0.92 took a 90th.
inline constexpr double kSvgPixel_m = 0.0254 / 96;

/// A length as SVG writes it.
struct SvgLength {
  double px = 0;          ///< of a percentage: its share of the reference
  bool absolute = false;  ///< in mm, cm, Q, in, pt or pc: it has a size in the world
  bool percent = false;
};

/// @param reference  what 100 % is (px)
/// @throws Error  at `where`: no number, an unknown unit (those of fonts are unknown)
SvgLength parse_svg_length(std::string_view text, double reference, const std::string& where);

}  // namespace geoprior
