#pragma once

#include "baselines/grammar/optimum/result.h"
#include "models/grammar/maps/spatial_map.h"

namespace geoprior::grammar {

/// The building of make_building that keeps all constraints and lies nearest to where a map takes
/// it: everything at once, with the elements of `children_fixed` present.
///
/// Minimises D^2 / 2, D the RMS over elements present in both states of the RMS over their key
/// points of |key - map(key at rest)|. Variables: of a storey the plan (x, y, yaw, width, depth),
/// levels of floors and of the top ceiling, of a wall's row its scale about the wall's middle
/// (`rest` has the distances), the roof's rise. Walls, openings and roof follow by the formulas of
/// building_layout.h. Constraints: heights, overhangs, pitch, openings within their walls, least
/// sides, the roof's rise. Tags are not looked at.
///
/// Limits enter by an augmented Lagrangian (Hestenes 1969, Powell 1969), whose terms are squares as
/// the rest is: each solve is one of Ceres. They are asked for with a margin of 1e-5 m, and a
/// result violates them by no more than that margin: so none of them. The gradient reported is that
/// of the Lagrangian; what the multipliers of limits that are not reached are worth is below 1e-6
/// of D^2 / 2.
///
/// What it cannot do: change the number of elements, or place the openings of a row one by one. A
/// local optimum, of two starts: `children_fixed`, and `rest` carried along with the ground.
/// @throws Error  where neither start ends within the constraints
OptimumResult optimise_building(const Hierarchy& rest, const Hierarchy& children_fixed,
                                const SpatialMap& map);

}  // namespace geoprior::grammar
