#pragma once

#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// The smooth bed under a region: vertices of `inside` move so that the bi-Laplacian of their
/// positions vanishes, the rest stays (two rings of it are the boundary condition). Same
/// connectivity. @param inside  1 for vertices that move
/// @return positions; those outside are unchanged. @throws Error when a component has no vertex
/// that stays
Eigen::MatrixX3d base_under(const TriMesh& mesh, const std::vector<char>& inside);

}  // namespace geoprior
