#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior {

/// Most points that a path may be flattened to.
inline constexpr std::size_t kMostSvgPathPoints = 2'000'000;

/// One line of a path, flattened to chords.
struct SvgSubpath {
  std::vector<Eigen::Vector2d> points;  ///< no two that follow each other are equal
  bool closed = false;                  ///< by Z; the first point is not repeated
  std::size_t character = 0;            ///< behind its first command, from 1; for errors
};

/// The lines that SVG path data draws.
///
/// All commands of SVG 1.1, absolute and relative: M L H V C S Q T A Z. Points that coincide with
/// the one before are left out, so that a subpath may have one point only; one that merely moves
/// the pen is none.
///
/// @param d          value of the attribute `d`
/// @param tolerance  largest distance of a curve from its chords (user units)
/// @param where      for errors: file and path
/// @throws Error     naming `where` and the character: unknown command, missing or bad number, no
///                   data, more points than kMostSvgPathPoints
/// Source: SVG 1.1 (W3C 2011), section 8.3; arcs: its implementation notes F.6.5 and F.6.6.
std::vector<SvgSubpath> flatten_svg_subpaths(std::string_view d, double tolerance,
                                             const std::string& where);

}  // namespace geoprior
