#pragma once

#include "baselines/grammar/optimum/result.h"
#include "models/grammar/maps/spatial_map.h"

namespace geoprior::grammar {

/// The positions of a set's elements ("item", "grain", "conifer") that deviate least from the
/// user's map, all of them found at once, with the elements that are present and their sizes as
/// given:
///
///   minimise 1/2 sum_i mean_k |key_ik - map(rest key_ik)|^2
///   subject to |x_i - x_j| >= s_i R_i + s_j R_j  for all pairs that are present.
///
/// A bound, not a method: positions are free in space, those of a surface's elements too, which
/// leave their triangles (whose numbers, among the parameters, are then out of date); and the turn
/// of an element with a tip is free, so that it points at where the tip is to go. Conifers stay
/// upright and at their height; those of a forest without spacing have no pairs. Elements that
/// were not there before have no target: they hold to where they are with a weight of 1e-6. All
/// other elements are as given.
///
/// Augmented Lagrangian: pairs that are near have the residual sqrt(rho) max(0, d_ij - |x_i - x_j|
/// + lambda_ij / rho), its inner problems are solved by Levenberg and Marquardt's method; from two
/// starts, the given state and where the map takes the rest state's positions. The problem is not
/// convex: the better of the two may still be a local minimum.
///
/// `gradient` is the largest component (m) of the Lagrangian's gradient by the positions; pairs
/// that push are at their distance within 3e-10 m. A start that does not come so far within 60
/// updates of the multipliers is taken only where the other one does not either, and when no pair
/// lacks more than 1e-9 m: its gradient tells.
///
/// @param rest            the object before the gesture
/// @param children_fixed  a result of it, whose pairs keep their distance
/// @throws Error          no elements of a set, or no start of such pairs
/// Source: Hestenes 1969; Nocedal and Wright 2006, chapter 17.
OptimumResult optimise_set(const Hierarchy& rest, const Hierarchy& children_fixed,
                           const SpatialMap& map);

}  // namespace geoprior::grammar
