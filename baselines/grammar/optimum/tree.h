#pragma once

#include "baselines/grammar/optimum/result.h"
#include "models/grammar/maps/spatial_map.h"

namespace geoprior::grammar {

/// The tree whose key points are nearest to where a map takes them, by optimising all branches at
/// once: over directions d_i and lengths L_i, least sum over elements of the mean squared deviation
/// of their key points, with the base of a branch at b_p + a_i L_p d_p on its parent p, and
/// 0.5 mean <= L_i <= 1.5 mean.
///
/// That branches must not cross is left out: the problem is a relaxation, and its optimum a lower
/// bound of what any method can reach that has the branches which were there at rest. It is not
/// convex: of two starts the better result is returned. Two starts are no proof of the least value
/// of all.
///
/// By Levenberg and Marquardt's method with a sparse Cholesky factorisation, on one thread.
///
/// @param rest            a tree as before the deformation
/// @param children_fixed  the same with the branches that a grammar added, at the place that it
///                        found: the first start; added branches are carried along
/// @throws Error  when the second tree has not the branches of the first
OptimumResult optimise_tree(const Hierarchy& rest, const Hierarchy& children_fixed,
                            const SpatialMap& map);

}  // namespace geoprior::grammar
