#pragma once

#include <Eigen/Core>

#include "baselines/fluid/liquid/grid/mac_grid.h"
#include "core/mesh.h"

namespace geoprior::fluid {

/// Level set 0 of a field at grid nodes as a closed, outward oriented 2-manifold for any field
/// (marching cubes whose table separates the ambiguous faces alike from both sides). Beyond the
/// border is outside: liquid that reaches it is closed there, a hundredth of a cell inside.
/// Vertices keep a hundredth of an edge off the nodes. A value of 0 is outside. Vertices in a fixed
/// order for any thread count.
/// Source: Lorensen and Cline 1987; for the ambiguous faces see isosurface_table.h.
/// @param origin, cell  of node (0, 0, 0) and between nodes (m)
TriMesh isosurface(const ScalarGrid& nodes, const Eigen::Vector3d& origin, double cell);

}  // namespace geoprior::fluid
