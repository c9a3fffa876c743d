#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "testbed/formats/svg/path.h"

namespace geoprior {

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
