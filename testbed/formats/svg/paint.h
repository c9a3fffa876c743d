#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "testbed/formats/svg/color.h"
#include "testbed/formats/svg/style.h"
#include "testbed/formats/text/xml.h"

namespace geoprior {

/// What of an element's style is inherited by what is in it.
struct SvgPaint {
  bool stroked = false;
  std::optional<SvgColour> stroke;  ///< absent where it is no single colour
  SvgColour color;                  ///< `currentColor`
  bool dashed = false;
  bool visible = true;
  bool filled = true;
  bool even_odd = false;  ///< fill-rule
};

/// The presentation attributes of an element that are read.
SvgProperties presentation_attributes(const pugi::xml_node& node);

/// The paint of an element that has these properties inside of one with the paint `outer`. A
/// gradient of one colour, which is what Inkscape makes of a swatch, is that colour.
/// @throws Error  at `where` for what names no colour
SvgPaint inherited_paint(const SvgPaint& outer, const SvgProperties& properties, const SvgXml& xml,
                         const SvgStyleSheet& sheet, const std::string& where);

/// The id of "url(#id)", in quotes or not; empty of anything else.
std::string_view id_of_svg_url(std::string_view value);

/// Classes, id and name that selectors look at; they live as long as `xml`.
SvgElementName selector_name(const SvgXml& xml, const pugi::xml_node& node);

}  // namespace geoprior
