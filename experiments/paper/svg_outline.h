#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior::paper {

/// The closed outline that SVG path data draws, with curves flattened to chords.
///
/// One subpath; it may be left open, filling closes it. Points that coincide with the one before
/// are left out.
///
/// @param d          value of the attribute `d`
/// @param tolerance  largest distance of a curve from its chords (user units)
/// @param where      for errors: file and path
/// @throws Error     as `flatten_svg_subpaths`; a second subpath, an outline without three points
///                   or with more than kMostCorners
std::vector<Eigen::Vector2d> flatten_svg_path(std::string_view d, double tolerance,
                                              const std::string& where);

}  // namespace geoprior::paper
