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

/// Particle-in-cell liquid on a staggered grid.
struct LiquidOptions {
  TransferKind transfer = TransferKind::flip;
  double pic_fraction = 0.03;  ///< alpha: share of PIC in the FLIP update
  int particles_per_cell = 8;
  double cfl = 3;         ///< cells that the fastest particle may cross in a substep
  int max_substeps = 32;  ///< of a frame
  VolumeCorrection volume_correction = VolumeCorrection::density;
  bool reseed = true;  ///< keep 3 … 2 x particles_per_cell particles in a full cell
  PressureOptions pressure;
  LiquidSurfaceOptions surface;
  bool record_particles = false;  ///< part "particles" of a frame
};
void describe(OptionVisitor& v, LiquidOptions& options);

/// One substep and what it left, for tests and metrics.
struct LiquidStepReport {
  double dt = 0;
  PressureReport pressure;
  double max_speed = 0;  ///< m/s
};

/// The simulation without recording: tests and the process below drive it.
class Liquid {
 public:
  Liquid(const Tank& tank, const LiquidOptions& options, std::uint64_t seed);
  ~Liquid();
  /// One substep of at most `dt_max` seconds.
  LiquidStepReport step(double dt_max, RunContext& context);
  [[nodiscard]] double time() const;
  [[nodiscard]] const LiquidParticles& particles() const;
  [[nodiscard]] LiquidParticles& particles();  ///< tests set velocities by it
  [[nodiscard]] const MacGrid& velocity() const;
  [[nodiscard]] const GridShape& shape() const;
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
/// (triangles to look at, cell array "solid" (index)), optionally "particles"; diagnostics
/// particles, particle_volume [m^3], substeps, pressure_iterations, max_divergence [1/s],
/// kinetic_energy, potential_energy [J], momentum_x/y/z, cfl, front quantities none. Phases:
/// "sort", "to_grid", "solids", "pressure", "extrapolate", "to_particles", "advect", "reseed",
/// "surface".
std::unique_ptr<Process> make_liquid(const Tank& tank, const LiquidOptions& options);

}  // namespace geoprior
