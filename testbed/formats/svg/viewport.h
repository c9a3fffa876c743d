#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "testbed/formats/svg/path.h"

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

/// What hides a part of what is in an element: a clip path, a mask, or the viewport of a nested svg
/// or a symbol.
struct SvgClip {
  std::string name;                     ///< "clip-path 'c' of g 'leaf'", for messages
  bool viewport = false;                ///< of a nested svg or symbol, with hidden overflow
  std::vector<Eigen::Vector2d> region;  ///< convex, what is left (m); empty: another shape
};

/// The points of a single convex line that runs round once, counter-clockwise; none of any other.
std::vector<Eigen::Vector2d> convex_region(const std::vector<SvgSubpath>& lines);

/// Whether a part of the lines is hidden, by more than a 10^9th of their size. True of a clip whose
/// region is not known.
bool hides_part_of(const SvgClip& clip, const std::vector<SvgSubpath>& lines);

/// The part of a closed line, seen as the border of an area, that lies in a convex region. What
/// falls apart is connected along the border of the region.
/// Source: Sutherland and Hodgman, Reentrant polygon clipping, 1974.
std::vector<Eigen::Vector2d> clipped_loop(std::vector<Eigen::Vector2d> loop,
                                          const std::vector<Eigen::Vector2d>& region);

}  // namespace geoprior
