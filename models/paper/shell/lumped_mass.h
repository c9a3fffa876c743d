#pragma once

#include <Eigen/Core>

#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// Mass of each vertex: a third of its triangles' (kg).
/// @throws Error  on a triangle without area or turned over, on a vertex that no triangle uses
Eigen::VectorXd lumped_masses(const ShellMesh& mesh, double area_density);

}  // namespace geoprior::paper
