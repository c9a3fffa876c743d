#pragma once

#include <array>
#include <memory>
#include <vector>

#include "baselines/fluid/mac_grid.h"

namespace geoprior {

struct PressureOptions {
  double tolerance = 1e-5;  ///< largest residual relative to the largest right-hand side
  int max_iterations = 400;
  double smallest_theta = 0.01;  ///< ghost-fluid fraction is clamped to this
};

struct PressureReport {
  int iterations = 0;
  double residual = 0;        ///< largest, relative to the largest right-hand side
  double max_divergence = 0;  ///< largest |div u| of liquid cells after projection (1/s)
  int liquid_cells = 0;
  bool converged = true;
};

/// Makes the velocity divergence free in the liquid: variational solid boundaries (area fractions,
/// moving solids), ghost-fluid free surface (second order), conjugate gradients with a modified
/// incomplete Cholesky preconditioner of level 0, matrix-free over the liquid cells; single
/// precision storage, sums in double in a fixed order.
/// Sources: Batty, Bertails and Bridson 2007; Enright et al. 2003; Bridson, Fluid Simulation, 2015,
/// ch. 4, 5.
class PressureSolver {
 public:
  explicit PressureSolver(const GridShape& shape);
  /// @param liquid_distance  at cell centres (m), negative in the liquid
  /// @param target_divergence  at cell centres (1/s), or empty: 0 (volume correction)
  /// @param velocity  is projected; only faces beside a liquid cell change
  /// @param valid  set to 1 on faces whose velocity is that of liquid, else 0 (for extrapolation)
  PressureReport project(const SolidFractions& solids, const ScalarGrid& liquid_distance,
                         const ScalarGrid* target_divergence, double dt, double density,
                         const PressureOptions& options, MacGrid& velocity,
                         std::array<std::vector<char>, 3>& valid);
  /// Pressure of the last call at cell centres (Pa), 0 outside the liquid.
  [[nodiscard]] const ScalarGrid& pressure() const { return pressure_; }

 private:
  GridShape shape_;
  ScalarGrid pressure_;
  struct Workspace;
  std::shared_ptr<Workspace> work_;
};

}  // namespace geoprior
