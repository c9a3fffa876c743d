#pragma once

#include <memory>

#include "baselines/fluid/liquid/pressure/pressure.h"
#include "baselines/fluid/liquid/surface/liquid_surface.h"
#include "baselines/fluid/liquid/tank/tank.h"
#include "core/context.h"
#include "core/method.h"
#include "core/options.h"

namespace geoprior::fluid {

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
  double pic_fraction = 0.03;  ///< alpha
  int particles_per_cell = 8;
  double cfl = 3;
  int max_substeps = 32;
  /// `density` moves particles, without changing their velocity, so that their density stays even.
  VolumeCorrection volume_correction = VolumeCorrection::density;
  double volume_rate = 30;
  bool reseed = true;
  PressureOptions pressure;
  LiquidSurfaceOptions surface;
  bool record_particles = false;
  int record_particles_every = 1;  ///< a splash has more bytes of particles than of surface
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

}  // namespace geoprior::fluid
