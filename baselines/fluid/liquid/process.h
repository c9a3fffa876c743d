#pragma once

#include <memory>

#include "baselines/fluid/liquid/liquid.h"
#include "core/method.h"

namespace geoprior::fluid {

/// The loop: one frame an interval; a checkpoint a frame.
///
/// Frames have the part "surface" (triangles, closed; point array "velocity" [m/s] (3)), "solids"
/// (triangles to look at, cell array "solid" (index)) when the tank has solids, optionally
/// "particles" (points; point array "velocity"). Diagnostics: particles; particle_volume [m^3]
/// (number over particles_per_cell cells); liquid_volume [m^3] (see LiquidStepReport; absent in
/// frame 0); surface_volume [m^3]; substeps; pressure_iterations (sum of the substeps);
/// max_divergence [1/s] (largest of a substep); pressure_converged (0 when a substep's solve did
/// not reach its tolerance); kinetic_energy, potential_energy [J] (of the particles; height 0 at
/// the coordinate origin); momentum_x, momentum_y, momentum_z [kg m/s]; cfl (cells that the fastest
/// particle crossed in a substep). Phases: "sort", "to_grid", "solids", "volume", "pressure",
/// "extrapolate", "to_particles", "reseed", "advect", "surface".
/// @throws Error  for a tank that is not valid; while running, when a frame needs more than
///                `max_substeps` or a velocity is not finite: frames made so far stay
std::unique_ptr<Process> make_liquid(const Tank& tank, const LiquidOptions& options);

}  // namespace geoprior::fluid
