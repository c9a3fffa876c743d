#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "baselines/fluid/liquid/grid/mac_grid.h"
#include "baselines/fluid/liquid/particles/particles.h"

namespace geoprior::fluid {

/// A side of the domain through which particles leave; without one all six sides keep them.
struct OpenSide {
  int axis = 2;
  bool upper = true;
};

/// Moves particles through a velocity u that stands still for `dt` (Ralston's third-order
/// Runge–Kutta, of least error bound),
///   k1 = u(x),  k2 = u(x + dt/2 k1),  k3 = u(x + 3 dt/4 k2),  x += dt/9 (2 k1 + 3 k2 + 4 k3),
/// then puts those that entered a solid or a wall back onto its surface along the gradient of the
/// distance. Eight particles are moved at a time (velocity_batch.h).
/// @param solids  null: only the walls of the domain
/// @param left  1 for particles that crossed the open side, else 0
/// Source: Ralston 1962; Bridson, Fluid Simulation, 2015, ch. 7.
void advect_particles(const MacGrid& velocity, double dt, const ScalarGrid* solids,
                      const std::optional<OpenSide>& open, LiquidParticles& particles,
                      std::vector<std::uint8_t>& left);

}  // namespace geoprior::fluid
