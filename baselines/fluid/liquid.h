#pragma once

#include <memory>

#include "baselines/fluid/liquid_surface.h"
#include "baselines/fluid/pressure.h"
#include "baselines/fluid/tank.h"
#include "core/context.h"
#include "core/method.h"
#include "core/options.h"

namespace geoprior {

enum class TransferKind { pic, flip, apic };
enum class VolumeCorrection { none, density };

/// Particle-in-cell liquid on a staggered grid (thesis 3.3: the simulation that sculpting spares).
///
/// Every substep: particles to grid (transfer.h), distance of the liquid from the particles'
/// density (volume_correction.h), gravity, projection (pressure.h), continuation beyond the liquid
/// (extrapolation.h), grid to particles, advection (advection.h). Particles that no liquid cell is
/// near fall freely. No viscosity, no surface tension; walls and solids are free slip. Velocities
/// are those half a step before the positions (leapfrog): gravity is of second order in time, the
/// splitting of advection and pressure of first, which damps eddies at large steps.
struct LiquidOptions {
  TransferKind transfer = TransferKind::flip;
  double pic_fraction = 0.03;  ///< alpha: share of PIC in the FLIP update
  int particles_per_cell = 8;
  double cfl = 3;         ///< cells that the fastest particle may cross in a substep
  int max_substeps = 32;  ///< of a frame; a frame that needs more ends the run with an Error
  /// `density` moves particles, without changing their velocity, so that their density stays even.
  VolumeCorrection volume_correction = VolumeCorrection::density;
  double volume_rate = 30;  ///< 1/s: deviations of density decay at this rate
  bool reseed = true;       ///< keep 3 … 2 x particles_per_cell particles in a full cell
  PressureOptions pressure;
  LiquidSurfaceOptions surface;
  bool record_particles = false;  ///< part "particles" of a frame
};
void describe(OptionVisitor& v, LiquidOptions& options);

/// One substep and what it left, for tests and metrics.
struct LiquidStepReport {
  double dt = 0;
  PressureReport pressure;
  PressureReport correction;  ///< of the volume; empty without
  double max_speed = 0;       ///< of particles, at the start of the step (m/s)
  double liquid_volume = 0;   ///< of the region that the pressure acts in, at the start (m^3)
};

/// The simulation without recording: tests and the process below drive it. Particles are sorted by
/// cell between steps.
class Liquid {
 public:
  /// @throws Error  as `require_valid` of the tank, at "tank"
  Liquid(const Tank& tank, const LiquidOptions& options, std::uint64_t seed);
  ~Liquid();
  /// One substep: `dt_max` divided by the least whole number for which no particle, solid or source
  /// crosses more than `cfl` cells (a source: one cell).
  /// @throws Error  when a velocity is no longer finite (names the time)
  LiquidStepReport step(double dt_max, RunContext& context);
  [[nodiscard]] double time() const;
  [[nodiscard]] const LiquidParticles& particles() const;
  [[nodiscard]] LiquidParticles& particles();  ///< tests set velocities by it
  [[nodiscard]] std::int64_t removed() const;  ///< particles that left by the open side
  [[nodiscard]] const MacGrid& velocity() const;
  [[nodiscard]] const GridShape& shape() const;
  [[nodiscard]] std::vector<PlacedSolid> solids() const;  ///< now; they refer to this object
  /// Closed surface of the liquid with velocities.
  [[nodiscard]] TriMesh surface(Eigen::MatrixX3d* velocity) const;
  [[nodiscard]] State save() const;
  void load(const State& state);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// The loop: one frame an interval; a checkpoint a frame.
///
/// Frames have the part "surface" (triangles, closed; point array "velocity" [m/s] (3)), "solids"
/// (triangles to look at, cell array "solid" (index)) when the tank has solids, optionally
/// "particles" (points; point array "velocity"). Diagnostics: particles; particle_volume [m^3]
/// (number over particles_per_cell cells); liquid_volume [m^3] (see LiquidStepReport; absent in
/// frame 0); surface_volume [m^3]; substeps; pressure_iterations (most of a substep);
/// max_divergence [1/s] (largest of a substep); pressure_converged (0 when a substep's solve did
/// not reach its tolerance); kinetic_energy, potential_energy [J] (of the particles; height 0 at
/// the coordinate origin); momentum_x, momentum_y, momentum_z [kg m/s]; cfl (cells that the fastest
/// particle crossed in a substep). Phases: "sort", "to_grid", "solids", "volume", "pressure",
/// "extrapolate", "to_particles", "reseed", "advect", "surface".
/// @throws Error  for a tank that is not valid; while running, when a frame needs more than
///                `max_substeps` or a velocity is not finite: frames made so far stay
std::unique_ptr<Process> make_liquid(const Tank& tank, const LiquidOptions& options);

}  // namespace geoprior
