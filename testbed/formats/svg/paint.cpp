#include "testbed/formats/svg/paint.h"

#include <algorithm>
#include <array>

#include "core/error.h"

namespace geoprior {
namespace {

constexpr int kMostGradients = 8;  // that take their stops from each other

std::string value_of(const SvgProperties& properties, std::string_view name) {
  const auto found = properties.find(name);
  return found == properties.end() ? std::string() : found->second;
}

/// The colour of a gradient that has one stop or equal ones.
std::optional<SvgColour> gradient_colour(std::string_view id, const SvgXml& xml,
                                         const SvgStyleSheet& sheet) {
  for (int step = 0; step < kMostGradients; ++step) {
    const pugi::xml_node gradient = xml.find(id);
    std::optional<SvgColour> colour;
    for (const pugi::xml_node& stop : gradient.children()) {
      if (xml.element(stop) != "stop") continue;
      const SvgProperties properties = sheet.cascade(
          selector_name(xml, stop), presentation_attributes(stop), stop.attribute("style").value());
      const std::optional<SvgColour> next = parse_svg_colour(value_of(properties, "stop-color"));
      if (!next || (colour && *colour != *next)) return std::nullopt;
      colour = next;
    }
    const std::string_view further = xml.href(gradient);
    if (colour || !further.starts_with('#')) return colour;
    id = further.substr(1);
  }
  return std::nullopt;
}

/// Of "url(#id) fallback".
void set_served_stroke(SvgPaint& paint, std::string_view value, const SvgXml& xml,
                       const SvgStyleSheet& sheet) {
  const std::size_t end = value.find(')');
  const std::string_view rest =
      end == std::string_view::npos ? std::string_view() : value.substr(end + 1);
  paint.stroked = true;
  paint.stroke = gradient_colour(id_of_svg_url(value), xml, sheet);
  if (!paint.stroke) paint.stroke = parse_svg_colour(rest);
}

void set_stroke(SvgPaint& paint, const std::string& value, const SvgXml& xml,
                const SvgStyleSheet& sheet, const std::string& where) {
  if (value.empty() || value == "inherit") return;
  paint.stroke.reset();
  paint.stroked = value != "none" && value != "transparent";
  if (!paint.stroked) return;
  if (value == "currentColor" || value == "currentcolor") {
    paint.stroke = paint.color;
  } else if (value.starts_with("url(")) {
    set_served_stroke(paint, value, xml, sheet);
  } else if (value != "context-stroke" && value != "context-fill") {
    paint.stroke = parse_svg_colour(value);
    if (!paint.stroke) {
      throw Error("stroke '" + value.substr(0, 200) + "' is no colour", where,
                  "a name of CSS, #rgb, #rrggbb, rgb(…), none");
    }
  }
}

/// "none" and lists of zeros draw whole lines.
bool is_dashed(std::string_view value) {
  return value != "none" && value.find_first_of("123456789") != std::string_view::npos;
}

}  // namespace

std::string_view id_of_svg_url(std::string_view value) {
  if (!value.starts_with("url(")) return {};
  const std::size_t end = value.find(')');
  std::string_view id = value.substr(4, end == std::string_view::npos ? end : end - 4);
  const std::size_t hash = id.find('#');
  id.remove_prefix(hash == std::string_view::npos ? id.size() : hash + 1);
  while (!id.empty() && std::string_view("\"' ").find(id.back()) != std::string_view::npos)
    id.remove_suffix(1);
  return id;
}

SvgElementName selector_name(const SvgXml& xml, const pugi::xml_node& node) {
  SvgElementName name;
  name.element = xml.element(node);
  name.id = node.attribute("id").value();
  std::string_view classes = node.attribute("class").value();
  constexpr std::string_view kBlanks = " \t\r\n\f";
  for (std::size_t at = classes.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(classes.find_first_of(kBlanks, at), classes.size());
    name.classes.push_back(classes.substr(at, end - at));
    at = classes.find_first_not_of(kBlanks, end);
  }
  return name;
}

SvgProperties presentation_attributes(const pugi::xml_node& node) {
  constexpr std::array<const char*, 12> kRead{
      "stroke", "stroke-dasharray", "color",     "display",   "visibility", "stop-color",
      "fill",   "fill-rule",        "clip-rule", "clip-path", "mask",       "overflow"};
  SvgProperties properties;
  for (const char* name : kRead) {
    const pugi::xml_attribute attribute = node.attribute(name);
    const std::string_view value = attribute.value();
    const std::size_t first = value.find_first_not_of(" \t\r\n\f");
    if (first == std::string_view::npos) continue;
    properties[name] = value.substr(first, value.find_last_not_of(" \t\r\n\f") - first + 1);
  }
  return properties;
}

SvgPaint inherited_paint(const SvgPaint& outer, const SvgProperties& properties, const SvgXml& xml,
                         const SvgStyleSheet& sheet, const std::string& where) {
  SvgPaint paint = outer;
  if (const auto color = parse_svg_colour(value_of(properties, "color"))) paint.color = *color;
  set_stroke(paint, value_of(properties, "stroke"), xml, sheet, where);
  const std::string dashes = value_of(properties, "stroke-dasharray");
  if (!dashes.empty() && dashes != "inherit") paint.dashed = is_dashed(dashes);
  const std::string visibility = value_of(properties, "visibility");
  if (!visibility.empty() && visibility != "inherit") paint.visible = visibility == "visible";
  const std::string fill = value_of(properties, "fill");
  if (!fill.empty() && fill != "inherit") paint.filled = fill != "none" && fill != "transparent";
  const std::string rule = value_of(properties, "fill-rule");
  if (!rule.empty() && rule != "inherit") paint.even_odd = rule == "evenodd";
  return paint;
}

}  // namespace geoprior
