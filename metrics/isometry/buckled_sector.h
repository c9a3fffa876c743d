#pragma once

#include <Eigen/Core>
#include <optional>

namespace geoprior {

/// Width of the sector over which a developable cone leaves the ring it is pushed into (degrees).
///
/// On a circle about the apex in the pattern the sheet lies on the ring, at a constant height over
/// the apex, but for one sector where it rises. There it leaves the ring with three derivatives, as
/// the cube of the angle, so the angle at which contact ends cannot be seen. What is measured is
/// the width at a fifth of the rise. The profiles psi = c1 cos t + c2 cos(a t) with psi = 1, psi' =
/// psi'' = 0 at the ends of the sector have the ratio 1.653 of sector to that width, within 0.3 %
/// for sectors of 110 to 160 degrees; inextensibility, that makes it 138.99, is not used.
///
/// @param pattern    n x 2 (m)
/// @param x          n x 3 (m)
/// @param triangles  m x 3
/// @param apex       in the pattern; its place in space is that of the nearest vertex
/// @param radius     of the circle in the pattern (m): where the ring is
/// @param axis       of the ring, either sense
/// @return  absent when the circle does not fit into the pattern, the apex is not below the circle,
///          the sheet rises by less than half of the depth of the apex (there is no cone yet), or
///          it leaves the ring in more than one sector
/// Source: Cerda and Mahadevan, Conical surfaces and crescent singularities in crumpled sheets,
/// 1998.
std::optional<double> buckled_sector(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3d& x,
                                     const Eigen::MatrixX3i& triangles, const Eigen::Vector2d& apex,
                                     double radius, const Eigen::Vector3d& axis);

}  // namespace geoprior
