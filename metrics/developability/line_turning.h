#pragma once

#include <Eigen/Core>

namespace geoprior {

/// How much a line turns.
struct LineTurning {
  double turning = 0;  ///< sum of the angles between consecutive segments (rad)
  double length = 0;   ///< m

  void add(const LineTurning& other) {
    turning += other.turning;
    length += other.length;
  }
};

/// Total turning of a polyline: 0 where it is straight, 2 pi around a convex plane curve, more
/// where it wanders (Fenchel; Milnor 1950, On the total curvature of knots: the polygon's angles
/// are the total curvature of the curve that it approximates).
///
/// Turning over length tells fair lines from wandering ones of any size on one object; it does not
/// tell one sharp corner from a bend, and grows where a line was sampled with noise: a point that
/// is off by d from a straight line of segments of length h adds about 4 d / h.
///
/// @param points  n x 3, none equal to the next (m); fewer than two: nothing
/// @param closed  the last point is joined to the first
LineTurning line_turning(const Eigen::MatrixX3d& points, bool closed);

/// The same within a surface, the integral of |geodesic curvature|: 0 along geodesics, 2 pi cos t
/// around a circle of a sphere at the angle t from its pole. Of a seam it is what its pattern
/// shows.
/// @param normals  n x 3, unit normals of the surface at the points
LineTurning line_turning_within(const Eigen::MatrixX3d& points, const Eigen::MatrixX3d& normals,
                                bool closed);

}  // namespace geoprior
