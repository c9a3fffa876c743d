#pragma once

#include <span>

#include "baselines/fluid/liquid/particles/particles.h"
#include "baselines/fluid/liquid/tank/tank.h"
#include "core/frame.h"

namespace geoprior::fluid {

/// The tank's solids as triangles to look at; cell array "solid": their index. A half space has
/// none.
/// @param placed  where they are, in the tank's order
Part solids_part(const Tank& tank, std::span<const PlacedSolid> placed);

/// Particles as points with their velocity, in world coordinates.
Part particles_part(const Tank& tank, const LiquidParticles& particles);

}  // namespace geoprior::fluid
