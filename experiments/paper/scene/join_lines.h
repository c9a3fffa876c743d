#pragma once

#include <Eigen/Core>
#include <vector>

#include "testbed/formats/svg/path.h"

namespace geoprior::paper {

/// Lines that were drawn piece by piece.
struct SvgJoinedLines {
  std::vector<SvgSubpath> closed;  ///< those that were, then those that became so
  std::vector<SvgSubpath> open;    ///< what touches nothing at an end
  int pieces = 0;                  ///< open lines of which closed ones were made
  double widest_gap = 0;           ///< that was closed (m)
};

/// Joins open lines whose ends are within `gap` of each other, nearest ends first, drawn either
/// way; ends that were apart meet in their middle. A line whose own ends are as near is closed.
SvgJoinedLines join_svg_lines(const std::vector<SvgSubpath>& lines, double gap);

}  // namespace geoprior::paper
