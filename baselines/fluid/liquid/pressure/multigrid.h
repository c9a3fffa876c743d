#pragma once

#include <memory>

#include "baselines/fluid/liquid/pressure/preconditioner.h"

namespace geoprior::fluid {

/// V-cycle over levels of 2 x 2 x 2 aggregates with piecewise constant prolongation, one red-black
/// Gauss–Seidel sweep before (even, odd) and after (odd, even).
///
/// The Galerkin matrix of constant prolongation is twice as stiff as the Laplacian of the coarse
/// grid (four fine links in place of the 4 / 2 of an area over a distance), so it is halved. Every
/// level keeps the seven-point form. Single precision: it only preconditions.
/// Source: Shao, Huang, Michels 2022; Braess 1995 (over-correction).
std::unique_ptr<PressureApproximation> make_multigrid_approximation();

}  // namespace geoprior::fluid
