#pragma once

#include <memory>

#include "core/method.h"
#include "core/options.h"
#include "models/torus/map.h"

namespace geoprior::torus {

struct GridOptions {
  int points = 2000;
};
void describe(OptionVisitor& v, GridOptions& options);

/// The corrugation process on a periodic grid of n x n points: between two corrugations the
/// surface is known at the points alone, its derivatives are differences of fourth order. Bands of
/// rows are computed one by one, with as many rows beside them as the corrugations to come need, so
/// that memory grows with n, not with its square; what frames do not ask for is forgotten.
///
/// It needs some 16 points a period of each corrugation: n = 2000 and N = 500 have two to four, and
/// what its own differences then say of the metric is not that of the surface.
///
/// Source: the corrugation process of Theillière 2022 on the sequence of Borrelli et al. 2012.
/// @throws Error  while running, naming corrugation and place where a coefficient is not positive
std::unique_ptr<Process> make_grid_torus(const TorusInput& input, const GridOptions& options);

}  // namespace geoprior::torus
