#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "models/sketch/surface/positive_winding.h"

namespace geoprior::sketch {

/// A straight stretch of a line that a box must not touch.
struct PlaneSegment {
  Eigen::Vector2d a, b;
};

/// The largest box of a given shape that lies inside closed loops and meets no segment.
///
/// The distance to the segments in the maximum norm, with x divided by the aspect, is half the
/// height of the largest such box about a point; a quadtree that splits its most promising cell
/// first finds a box at most 2 % smaller than the largest.
///
/// @param loops      even-odd inside; they are obstacles too
/// @param obstacles  further segments
/// @param aspect     width of the box over its height, positive
/// @return           an empty box when there is no inside
Eigen::AlignedBox2d largest_clear_box(const std::vector<PlaneLoop>& loops,
                                      const std::vector<PlaneSegment>& obstacles, double aspect);

/// True when the box lies inside the loops and meets neither them nor the obstacles.
bool is_clear(const Eigen::AlignedBox2d& box, const std::vector<PlaneLoop>& loops,
              const std::vector<PlaneSegment>& obstacles);

}  // namespace geoprior::sketch
