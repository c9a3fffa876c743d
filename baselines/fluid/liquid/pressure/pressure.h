#pragma once

#include <array>
#include <memory>
#include <vector>

#include "baselines/fluid/liquid/grid/mac_grid.h"
#include "core/options.h"

namespace geoprior::fluid {

enum class PressurePreconditioner { multigrid, incomplete_cholesky };

struct PressureOptions {
  PressurePreconditioner preconditioner = PressurePreconditioner::multigrid;
  double tolerance = 1e-5;
  int max_iterations = 400;
  /// Ghost-fluid fraction is clamped to this: moves a surface by at most this share of a cell.
  double smallest_theta = 0.01;
};
void describe(OptionVisitor& v, PressureOptions& options);

struct PressureReport {
  int iterations = 0;
  double residual = 0;        ///< largest, relative to the largest right-hand side
  double max_divergence = 0;  ///< largest |div u - target| of liquid cells after projection (1/s)
  int liquid_cells = 0;       ///< unknowns
  int enclosed_regions = 0;   ///< connected liquid that no air touches: pressure up to a constant
  bool converged = true;
};

/// Makes the velocity divergence free in the liquid: variational solid boundaries (area fractions,
/// moving solids), ghost-fluid free surface (second order), conjugate gradients.
///
/// For every liquid cell, with a the open fraction of a face, u* the velocity given, u_s that of
/// the solid and P = p dt / (rho h):
///   sum over faces of a (P - P_neighbour) = -sum over faces of s [a u* + (1 - a) u_s] + h d,
/// s = +1 on the upper face of an axis and -1 on the lower one, d the target divergence.
/// A neighbour with air stands for a pressure of 0 at the surface between, at the fraction
/// theta = phi / (phi - phi_air) of the way: a P / theta in place of a (P - P_neighbour). Beyond an
/// open side of the domain the pressure is 0 on the border. Then u = u* - (difference of P).
///
/// A cell is liquid where its distance is negative and one of its faces is open. Liquid that no air
/// touches has a pressure up to a constant: its right-hand side loses its mean (a volume that
/// solids squeeze cannot be kept), its pressure too.
///
/// Unknowns are a compact list of liquid cells. The preconditioner is a V-cycle of unsmoothed
/// aggregation with red-black Gauss–Seidel, or modified incomplete Cholesky of level 0 in a fixed
/// number of slabs. Sums in double in a fixed order: the same bits for any number of threads.
/// Sources: Batty, Bertails and Bridson 2007; Enright et al. 2003; Bridson, Fluid Simulation, 2015,
/// ch. 4, 5; Shao, Huang, Michels 2022 (aggregation).
class PressureSolver {
 public:
  explicit PressureSolver(const GridShape& shape);
  /// @param liquid_distance  at cell centres (m), negative in the liquid; see `extend_into_solids`
  /// @param target_divergence  at cell centres (1/s), or null: 0 (volume correction)
  /// @param velocity  is projected; only faces beside a liquid cell change
  /// @param valid  set to 1 on faces whose velocity is that of liquid, else 0 (for extrapolation):
  ///               open faces of liquid cells, and their closed faces on the walls of the domain
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

}  // namespace geoprior::fluid
