#pragma once

#include <span>

#include "baselines/fluid/mac_grid.h"
#include "baselines/fluid/tank.h"

namespace geoprior {

/// Distances at nodes and open area fractions of faces (marching squares on the face's four node
/// distances), walls of the domain included. Fractions below 1 % are closed.
/// Source: Batty, Bertails and Bridson 2007.
void solid_fractions(const Tank& tank, std::span<const PlacedSolid> solids, const GridShape& shape,
                     SolidFractions& out);

}  // namespace geoprior
