#pragma once

#include <memory>
#include <vector>

#include "baselines/fluid/pressure.h"
#include "baselines/fluid/pressure_system.h"

namespace geoprior {

/// z = M r with M symmetric positive definite and near the inverse of the system.
class PressureApproximation {
 public:
  virtual ~PressureApproximation() = default;
  /// Takes a system that outlives the calls of `apply`; keeps its memory for the next one.
  virtual void build(const PressureSystem& system) = 0;
  virtual void apply(const std::vector<double>& r, std::vector<double>& z) = 0;
};

/// V-cycle over levels of 2 x 2 x 2 aggregates with piecewise constant prolongation, one red-black
/// Gauss–Seidel sweep before (even, odd) and after (odd, even).
///
/// The Galerkin matrix of constant prolongation is twice as stiff as the Laplacian of the coarse
/// grid (four fine links in place of the 4 / 2 of an area over a distance), so it is halved. Every
/// level keeps the seven-point form. Single precision: it only preconditions.
/// Source: Shao, Huang, Michels 2022; Braess 1995 (over-correction).
std::unique_ptr<PressureApproximation> make_multigrid_approximation();

/// Modified incomplete Cholesky of level 0 (tau 0.97, sigma 0.25) within slabs of unknowns whose
/// number is fixed; links between slabs are dropped, so that slabs run side by side.
/// Source: Bridson, Fluid Simulation, 2015, section 5.3.
std::unique_ptr<PressureApproximation> make_incomplete_cholesky_approximation();

}  // namespace geoprior
