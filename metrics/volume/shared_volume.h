#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "core/mesh.h"

namespace geoprior {

/// Balls, by rows: particles with the space that each stands for.
struct Balls {
  Eigen::MatrixX3d centres;  ///< m
  Eigen::VectorXd radii;     ///< m, positive
};

/// The box that has every point in it.
inline Eigen::AlignedBox3d everywhere() {
  const Eigen::Vector3d far = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  return {-far, far};
}

/// Two volumes and what they share (m^3).
struct SharedVolume {
  double first = 0, second = 0, both = 0;

  /// Intersection over union, 0 (apart) to 1 (equal); absent when both are empty.
  [[nodiscard]] std::optional<double> intersection_over_union() const;
};

/// The union of balls (first), the inside of a closed surface (second), and their intersection:
/// whether a surface wraps the particles that it was drawn from.
///
/// Upright columns on a square grid. Along a column the lengths are exact, so that the only error
/// is the grid's; it falls about as spacing^1.5 at round borders. A point is inside the surface
/// where the winding number is positive; balls may overlap each other and count once.
///
/// The result does not depend on the number of threads. Memory follows the columns of a strip of
/// the grid, not of all of it.
///
/// @param surface  closed, outward oriented
/// @param spacing  of the columns (m), positive; half the smallest radius or less
/// @param room     of the balls: what of them is outside does not count, as behind a tank's walls
/// @throws Error   on numbers that are not finite, a radius or spacing that is not positive, or
///                 more than 2^28 columns
SharedVolume shared_volume(const Balls& balls, const TriMesh& surface, double spacing,
                           const Eigen::AlignedBox3d& room = everywhere());

}  // namespace geoprior
