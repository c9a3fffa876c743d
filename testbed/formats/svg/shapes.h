#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "testbed/formats/svg/path.h"

namespace geoprior {

/// What the lengths of a shape are read against.
struct SvgShapeFrame {
  double width = 0, height = 0;  ///< of the viewport (user units): 100 %
  double tolerance = 1;          ///< of curves (user units)
};

/// The value of an attribute, empty when there is none.
using SvgAttributes = std::function<std::string_view(std::string_view name)>;

/// path, line, polyline, polygon, rect, circle, ellipse.
bool is_svg_shape(std::string_view element);

/// The lines that a shape draws, in user units, y down. A path without data, and a rect or ellipse
/// without an extent, draw none.
/// @throws Error  naming `where` and attribute: malformed, a negative size, an odd number of
///                coordinates
/// Source: SVG 1.1 (W3C 2011), section 9.
std::vector<SvgSubpath> svg_shape_lines(std::string_view element, const SvgAttributes& attributes,
                                        const SvgShapeFrame& frame, const std::string& where);

}  // namespace geoprior
