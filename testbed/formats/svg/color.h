#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace geoprior {

struct SvgColour {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(const SvgColour&, const SvgColour&) = default;
};

/// The colour that a text names: one of the 148 names of CSS in any case, #rgb, #rrggbb, rgb(…)
/// with numbers or percentages. Opacity (#rgba, rgba(…)) is read and left out. Absent for anything
/// else ("none", "url(#a)", "currentColor").
/// Source: CSS Color Module Level 4 (W3C 2022), sections 4 to 6.
std::optional<SvgColour> parse_svg_colour(std::string_view text);

/// "#ff8000".
std::string to_text(const SvgColour& colour);

}  // namespace geoprior
