#pragma once

#include <memory>

#include "baselines/fluid/liquid/pressure/preconditioner.h"

namespace geoprior::fluid {

/// Modified incomplete Cholesky of level 0 (tau 0.97, sigma 0.25) within slabs of unknowns whose
/// number is fixed; links between slabs are dropped, so that slabs run side by side.
/// Source: Bridson, Fluid Simulation, 2015, section 5.3.
std::unique_ptr<PressureApproximation> make_incomplete_cholesky_approximation();

}  // namespace geoprior::fluid
