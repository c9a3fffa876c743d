#pragma once

#include <span>
#include <vector>

#include "models/grammar/maps/spatial_map.h"
#include "models/grammar/record.h"

namespace geoprior::grammar {

/// 1 for an element and all below it, 0 for the others: one number an element.
std::vector<char> elements_below(const Hierarchy& hierarchy, int element);

/// Whether an element moves.
/// @param moved  one number an element: those with 0 stay; empty: all move
/// @throws Error  `moved` that is too short
bool moves(std::span<const char> moved, int element);

/// Free-form deformation: every key point and every vertex goes where the map takes it. It knows
/// no elements and keeps nothing: right angles, lengths, spacing and contact change with the map.
///
/// @param moved   as of `moves`: what does not move stays, bit for bit
/// Source: Sederberg and Parry 1986.
Geometry free_form(const Geometry& before, const SpatialMap& map, std::span<const char> moved = {});

}  // namespace geoprior::grammar
