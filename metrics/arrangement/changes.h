#pragma once

#include <Eigen/Core>
#include <span>

namespace geoprior {

/// Diameter of the smallest ball about the mean of the points that holds them (m): the length of a
/// segment, the diagonal of a box of its corners. 0 for fewer than two points.
double extent_of(std::span<const Eigen::Vector3d> points);

/// Largest change of a distance between two points of a group (m): 0 for a rigid motion, to
/// round-off, and for a reflection.
/// @throws Error  when sizes differ
double distance_change(std::span<const Eigen::Vector3d> before,
                       std::span<const Eigen::Vector3d> after);

/// Largest displacement between two frames that the change of the map that the user asks for does
/// not explain (m): popping.
///
/// A point that moved by d while the map's change would have moved it by m may have stayed,
/// followed, or done anything between: what is left over is the distance of d from the segment from
/// 0 to m. A point that moves further than it is asked to, aside, or with no reason, pops.
///
/// What is carried along by something that follows (the twig of a branch that the map turns) moves
/// without being asked: in small steps that is small, a pop is not.
/// @param before,after              where the points are in the two frames
/// @param asked_before,asked_after  where the map has them
/// @throws Error  when sizes differ
double unexplained_displacement(std::span<const Eigen::Vector3d> before,
                                std::span<const Eigen::Vector3d> after,
                                std::span<const Eigen::Vector3d> asked_before,
                                std::span<const Eigen::Vector3d> asked_after);

}  // namespace geoprior
