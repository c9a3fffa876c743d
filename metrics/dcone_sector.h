#pragma once

#include <Eigen/Core>

namespace geoprior {

/// Slope of a sheet that hangs from its apex, around it: samples of (height over the apex) /
/// (horizontal distance from it) on a circle of the pattern, linear between vertices.
///
/// @param V          n x 3 (m), heights along z
/// @param pattern    n x 2 (m)
/// @param triangles  m x 3
/// @param apex       vertex
/// @param radius     of the circle about the apex in the pattern (m)
/// @param samples    at angles 2 pi (i + 1/2) / samples of the pattern
/// @throws Error     when a sample lies outside the pattern
Eigen::VectorXd slope_profile(const Eigen::MatrixX3d& V, const Eigen::MatrixX2d& pattern,
                              const Eigen::MatrixX3i& triangles, int apex, double radius,
                              int samples = 360);

/// Angle (degrees) over which a d-cone lifts off the ring that it is pushed into.
///
/// In contact the slope is constant. Where it lifts off, slope and bending moment are continuous,
/// so the lift grows as the cube of the angle: its cube root is extrapolated to zero from where it
/// is between 3 % and 15 % of the largest, on both sides of it. A threshold alone would lose some
/// 15 degrees a side.
///
/// Inextensible sheets at small deflection: 138.99 degrees; finite thickness less, converging
/// slowly.
/// @param profile  slopes at equal angles around the apex, one buckle
/// @throws Error   when there is no buckle or too few samples on its flanks
/// Source: Cerda and Mahadevan 1998, 2005.
double dcone_sector(const Eigen::VectorXd& profile);

}  // namespace geoprior
