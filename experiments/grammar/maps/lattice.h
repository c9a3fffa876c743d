#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "models/grammar/maps/spatial_map.h"
#include "models/grammar/maps/tools.h"

namespace geoprior::grammar {

/// @throws Error  naming `where`: a box without volume, counts of control points outside 2 … 16, as
///                many shifts as there are no points, a number that is not finite
void require_valid(const Lattice& lattice, const std::string& where);

/// x + sum_ijk B_i(u) B_j(v) B_k(w) shift_ijk in the box, u, v, w = 0 … 1 along it: shifts that are
/// affine in the control points' positions give an affine map (linear precision of Bernstein's
/// polynomials).
///
/// Outside of the box it is the identity. So it is continuous, and has an inverse, only where the
/// outermost layer of control points rests; where that moves, the box has to hold all of the
/// object, before and after.
///
/// Cost: in proportion to the number of control points.
/// Source: Sederberg and Parry 1986.
class LatticeMap final : public SpatialMap {
 public:
  /// @param lattice   valid
  /// @param fraction  of its shifts
  LatticeMap(const Lattice& lattice, double fraction);
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& x) const override;
  [[nodiscard]] MappedPoint with_jacobian(const Eigen::Vector3d& x) const override;
  [[nodiscard]] std::optional<Eigen::AlignedBox3d> support() const override { return box_; }

 private:
  [[nodiscard]] Eigen::Vector3d place_in_box(const Eigen::Vector3d& x) const;

  Lattice lattice_;  ///< its shifts times the fraction
  Eigen::AlignedBox3d box_;
};

}  // namespace geoprior::grammar
