#pragma once

#include <vector>

#include "core/connectivity.h"
#include "models/paper/shell_state.h"

namespace geoprior::paper {

/// Separates a sheet along edges of its mesh: a vertex whose triangles the edges divide into
/// several groups is there once for each. Tips, where the triangles still hang together on one
/// side, stay. Triangles keep their numbers and corners; the first group keeps the vertex, the
/// others get new ones at the end, in the order of the vertices they double.
///
/// @param along  undirected edges of the mesh, ascending; those that are none of it are passed over
void open_along(ShellMesh& mesh, const std::vector<Edge>& along);

/// Whether the mesh is cut open: two of its vertices have the same place in the pattern.
bool has_lips(const ShellMesh& mesh);

/// Number of parts that hold together over edges.
int part_count(const Eigen::MatrixX3i& triangles);

}  // namespace geoprior::paper
