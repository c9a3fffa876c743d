#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior::sketch {

/// Where a point lies beside an open or closed stroke.
struct BesideStroke {
  double distance = 0;  ///< signed: positive to the left of the stroke (m)
  /// Arc length of the nearest point; beyond an end of an open stroke on the straight line that
  /// goes on there: negative, or more than the length (m).
  double along = 0;
  Eigen::Vector2d direction{1, 0};  ///< of the stroke there, unit
};

/// @param points  two or more, none equal to the next; a closed stroke repeats the first one
BesideStroke beside(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& x);

/// Point at an arc length, on the straight continuation beyond the ends.
Eigen::Vector2d point_along(const std::vector<Eigen::Vector2d>& points, double along);

/// Length of the polyline (m).
double length(const std::vector<Eigen::Vector2d>& points);

}  // namespace geoprior::sketch
