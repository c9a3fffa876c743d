#pragma once

#include "baselines/grammar/optimum/result.h"
#include "models/grammar/maps/spatial_map.h"

namespace geoprior::grammar {

/// The state of a whole object that is nearest to a map under the object's constraints, found by
/// optimising all of it at once: a tree (tree.h), a building (building.h), a set or a forest
/// (sets.h), told by the type of the root.
///
/// @param rest            before the map
/// @param children_fixed  a result of it, whose elements are kept, and one of the two starts
/// @throws Error          for any other object, naming its type
OptimumResult optimise_object(const Hierarchy& rest, const Hierarchy& children_fixed,
                              const SpatialMap& map);

}  // namespace geoprior::grammar
