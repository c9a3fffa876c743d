#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior::paper {

/// The closed outline that SVG path data draws, with curves flattened to chords.
///
/// All commands of SVG 1.1, absolute and relative: M L H V C S Q T A Z. One subpath; it may be left
/// open, filling closes it. Points that coincide with the one before are left out.
///
/// @param d          value of the attribute `d`
/// @param tolerance  largest distance of a curve from its chords (user units)
/// @param where      for errors: file and path
/// @throws Error     naming `where` and the character: unknown command, missing or bad number, a
///                   second subpath, an outline without three points
/// Source: SVG 1.1 (W3C 2011), section 8.3; arcs: its implementation notes F.6.5 and F.6.6.
std::vector<Eigen::Vector2d> flatten_svg_path(std::string_view d, double tolerance,
                                              const std::string& where);

}  // namespace geoprior::paper
