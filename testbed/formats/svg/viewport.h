#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>

namespace geoprior {

/// An upright rectangle of SVG: y points down, (x, y) is its upper left corner.
struct SvgBox {
  double x = 0, y = 0, width = 0, height = 0;
};

/// How a rectangle is fitted into another: `preserveAspectRatio`.
struct SvgAspect {
  bool stretched = false;           ///< "none": in x and y on their own
  bool covers = false;              ///< "slice": the whole target, else "meet": inside of it
  Eigen::Vector2d align{0.5, 0.5};  ///< 0 at the left or upper side, 1 at the right or lower one
};

/// Absent where the text is empty. @throws Error  at `where`: not four numbers, a negative size
std::optional<SvgBox> parse_svg_view_box(std::string_view text, const std::string& where);

/// "xMidYMid meet" where the text is empty. @throws Error  at `where`
SvgAspect parse_svg_aspect(std::string_view text, const std::string& where);

/// The map from `from` into `to`. The sizes of `from` are positive.
/// Source: SVG 1.1 (W3C 2011), sections 7.7 and 7.8.
Eigen::Affine2d fit_svg_box(const SvgBox& from, const SvgBox& to, const SvgAspect& aspect);

}  // namespace geoprior
