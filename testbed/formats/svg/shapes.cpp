#include "testbed/formats/svg/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "testbed/formats/svg/curves.h"
#include "testbed/formats/svg/text.h"
#include "testbed/formats/svg/units.h"

namespace geoprior {
namespace {

/// Reads the lengths of one shape.
class ShapeLengths {
 public:
  ShapeLengths(const SvgAttributes& attributes, const SvgShapeFrame& frame,
               const std::string& where)
      : attributes_(attributes), frame_(frame), where_(where) {}

  [[nodiscard]] double along_x(std::string_view name) const { return value(name, frame_.width); }
  [[nodiscard]] double along_y(std::string_view name) const { return value(name, frame_.height); }
  /// Of no direction: percentages of the root mean square.
  [[nodiscard]] double round(std::string_view name) const {
    return size(name, std::hypot(frame_.width, frame_.height) / std::sqrt(2.0)).value_or(0);
  }
  /// Absent for "auto" and where there is none. @throws Error  when it is negative
  [[nodiscard]] std::optional<double> size(std::string_view name, double reference) const {
    const std::string_view text = attributes_(name);
    if (text.empty() || text == "auto") return std::nullopt;
    const double length = value(name, reference);
    if (length < 0) throw Error(std::string(name) + " is negative", where_, "at least 0");
    return length;
  }
  [[nodiscard]] Eigen::Vector2d size_of(std::string_view x, std::string_view y) const {
    return {size(x, frame_.width).value_or(0), size(y, frame_.height).value_or(0)};
  }

 private:
  [[nodiscard]] double value(std::string_view name, double reference) const {
    const std::string_view text = attributes_(name);
    if (text.empty()) return 0;
    return parse_svg_length(text, reference, where_ + ": " + std::string(name)).px;
  }

  const SvgAttributes& attributes_;
  const SvgShapeFrame& frame_;
  const std::string& where_;
};

/// A closed line through quarters of ellipses, with straight lines between them.
class ShapeOutline {
 public:
  ShapeOutline(const Eigen::Vector2d& start, double tolerance) : tolerance_(tolerance) {
    add(start);
  }

  void line_to(const Eigen::Vector2d& p) { add(p); }
  /// Clockwise on the page, as SVG draws its shapes.
  void quarter_to(const Eigen::Vector2d& p, const Eigen::Vector2d& radii) {
    std::vector<Eigen::Vector2d> arc;
    flatten_arc({line_.points.back(), p, radii, 0, false, true}, tolerance_, arc);
    for (const Eigen::Vector2d& q : arc) add(q);
  }
  SvgSubpath closed() {
    while (line_.points.size() > 1 && line_.points.front() == line_.points.back())
      line_.points.pop_back();
    line_.closed = true;
    return std::move(line_);
  }

 private:
  void add(const Eigen::Vector2d& p) {
    if (line_.points.empty() || p != line_.points.back()) line_.points.push_back(p);
  }

  double tolerance_;
  SvgSubpath line_;
};

SvgSubpath ellipse_outline(const Eigen::Vector2d& centre, const Eigen::Vector2d& radii,
                           double tolerance) {
  const Eigen::Vector2d right(radii.x(), 0), down(0, radii.y());
  ShapeOutline outline(centre + right, tolerance);
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(centre + down), Eigen::Vector2d(centre - right),
                                   Eigen::Vector2d(centre - down), Eigen::Vector2d(centre + right)})
    outline.quarter_to(p, radii);
  return outline.closed();
}

/// @param radii  of the corners, at most half the size
SvgSubpath rectangle_outline(const Eigen::Vector2d& low, const Eigen::Vector2d& size,
                             const Eigen::Vector2d& radii, double tolerance) {
  const Eigen::Vector2d high = low + size;
  const double rx = radii.x(), ry = radii.y();
  ShapeOutline outline({low.x() + rx, low.y()}, tolerance);
  outline.line_to({high.x() - rx, low.y()});
  outline.quarter_to({high.x(), low.y() + ry}, radii);
  outline.line_to({high.x(), high.y() - ry});
  outline.quarter_to({high.x() - rx, high.y()}, radii);
  outline.line_to({low.x() + rx, high.y()});
  outline.quarter_to({low.x(), high.y() - ry}, radii);
  outline.line_to({low.x(), low.y() + ry});
  outline.quarter_to({low.x() + rx, low.y()}, radii);
  return outline.closed();
}

std::vector<SvgSubpath> rectangle_lines(const ShapeLengths& lengths, const SvgShapeFrame& frame) {
  const Eigen::Vector2d low(lengths.along_x("x"), lengths.along_y("y"));
  const Eigen::Vector2d size = lengths.size_of("width", "height");
  if (size.minCoeff() == 0) return {};
  const std::optional<double> rx = lengths.size("rx", frame.width);
  const std::optional<double> ry = lengths.size("ry", frame.height);
  Eigen::Vector2d radii(rx.value_or(ry.value_or(0)), ry.value_or(rx.value_or(0)));
  radii = radii.cwiseMin(size / 2);
  if (radii.minCoeff() == 0) radii.setZero();
  return {rectangle_outline(low, size, radii, frame.tolerance)};
}

std::vector<SvgSubpath> ellipse_lines(std::string_view element, const ShapeLengths& lengths,
                                      const SvgShapeFrame& frame) {
  const Eigen::Vector2d centre(lengths.along_x("cx"), lengths.along_y("cy"));
  Eigen::Vector2d radii;
  if (element == "circle") {
    radii.setConstant(lengths.round("r"));
  } else {
    const std::optional<double> rx = lengths.size("rx", frame.width);
    const std::optional<double> ry = lengths.size("ry", frame.height);
    radii = {rx.value_or(ry.value_or(0)), ry.value_or(rx.value_or(0))};
  }
  if (radii.minCoeff() == 0) return {};
  return {ellipse_outline(centre, radii, frame.tolerance)};
}

std::vector<SvgSubpath> corner_lines(std::string_view points, bool closed,
                                     const std::string& where) {
  SvgText text(points, where);
  SvgSubpath line;
  while (text.peek() != 0) {
    const double x = text.number();
    const double y = text.number();
    const Eigen::Vector2d p(x, y);
    if (line.points.empty() || p != line.points.back()) line.points.push_back(p);
    if (line.points.size() > kMostSvgPathPoints)
      text.fail("has too many points", std::to_string(kMostSvgPathPoints));
  }
  if (line.points.empty()) return {};
  while (closed && line.points.size() > 1 && line.points.front() == line.points.back())
    line.points.pop_back();
  line.closed = closed;
  return {line};
}

}  // namespace

bool is_svg_shape(std::string_view element) {
  constexpr std::array<std::string_view, 7> kShapes{"path", "line",   "polyline", "polygon",
                                                    "rect", "circle", "ellipse"};
  return std::find(kShapes.begin(), kShapes.end(), element) != kShapes.end();
}

std::vector<SvgSubpath> svg_shape_lines(std::string_view element, const SvgAttributes& attributes,
                                        const SvgShapeFrame& frame, const std::string& where) {
  const ShapeLengths lengths(attributes, frame, where);
  if (element == "path") {
    const std::string_view d = attributes("d");
    if (d.find_first_not_of(" \t\r\n\f") == std::string_view::npos || d == "none") return {};
    return flatten_svg_subpaths(d, frame.tolerance, where + ": d");
  }
  if (element == "polyline" || element == "polygon")
    return corner_lines(attributes("points"), element == "polygon", where + ": points");
  if (element == "rect") return rectangle_lines(lengths, frame);
  if (element == "circle" || element == "ellipse") return ellipse_lines(element, lengths, frame);
  const Eigen::Vector2d from(lengths.along_x("x1"), lengths.along_y("y1"));
  const Eigen::Vector2d to(lengths.along_x("x2"), lengths.along_y("y2"));
  if (from == to) return {SvgSubpath{{from}, false, 0}};
  return {SvgSubpath{{from, to}, false, 0}};
}

}  // namespace geoprior
