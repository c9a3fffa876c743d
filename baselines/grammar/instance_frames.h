#pragma once

#include "models/grammar/hierarchy/hierarchy.h"
#include "models/grammar/maps/spatial_map.h"

namespace geoprior::grammar {

/// Deformation of the elements' frames alone, as for instances of a scene: each is moved to where
/// the map takes its origin and turned by the rotation of the polar decomposition of the map's
/// derivative there. Parameters stay, so that every element keeps its shape; what holds between
/// elements does not. Points of an element's own go where the map takes them.
///
/// Elements outside of the map's support stay, bit for bit.
/// @param element  it and all below it are moved
Hierarchy instance_frames(const Hierarchy& before, const SpatialMap& map, int element = 0);

}  // namespace geoprior::grammar
