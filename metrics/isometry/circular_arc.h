#pragma once

#include <Eigen/Core>

namespace geoprior {

/// A chain of points as a circular arc.
struct CircularArc {
  Eigen::Vector3d centre{0, 0, 0};
  Eigen::Vector3d axis{0, 0, 1};  ///< unit; the chain turns counter-clockwise about it
  double radius = 0;              ///< m; infinite for points on a line
  double angle = 0;               ///< from the first point to the last along the chain (rad)
  double length = 0;              ///< radius times angle; of points on a line their distance (m)
  double off = 0;                 ///< largest distance of a point from the circle (m)
};

/// Circle through the first, the middle and the last point of the chain, and the length of its arc:
/// of points that lie on a circle exactly, where a sum over chords falls short. Says nothing good
/// of points that do not: read `off`.
///
/// @param points  n x 3, three or more, in their order, over less than a full turn
/// @throws Error  on fewer than three points, or where first, middle and last are not distinct
CircularArc circular_arc(const Eigen::MatrixX3d& points);

/// How an arc differs from the one that it ought to be, whatever their centres.
struct ArcDifference {
  double radius = 0;  ///< relative to the true one
  double axis = 0;    ///< angle between the axes' lines (rad), 0 to pi / 2
};
ArcDifference arc_difference(const CircularArc& arc, const CircularArc& truth);

}  // namespace geoprior
