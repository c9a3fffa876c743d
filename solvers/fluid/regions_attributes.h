#pragma once

#include <vector>

#include "solvers/fluid/curvature.h"
#include "solvers/fluid/regions.h"

namespace geoprior::fluid {

/// Regions 1 … `count` of labelled vertices: integrals over their mixed areas, box and support.
/// Frame, kind and volume are the caller's. @param velocity  one row per vertex (m/s), or none
std::vector<Region> region_attributes(const SurfaceGraph& graph, const SurfaceShape& shape,
                                      const std::vector<int>& label, int count,
                                      const Eigen::MatrixX3d& velocity, double cell);

}  // namespace geoprior::fluid
