#pragma once

#include "baselines/fluid/liquid/particles/particles.h"
#include "baselines/fluid/liquid/tank/tank.h"

namespace geoprior::fluid {

/// Largest speed of a particle (m/s).
/// @throws Error  when a velocity is not finite; names `time`
double fastest_particle(const LiquidParticles& particles, double time);

/// Bound of the speed of a solid's points: of its centre plus that of its turn (m/s).
double fastest_point(const PlacedSolid& solid);

}  // namespace geoprior::fluid
