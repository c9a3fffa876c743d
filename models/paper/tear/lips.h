#pragma once

#include <vector>

#include "core/connectivity.h"
#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// Separates a sheet along edges of its mesh: a vertex whose triangles the edges divide into
/// several groups is there once for each. Tips, where the triangles still hang together on one
/// side, stay. Triangles keep their numbers and corners; the first group keeps the vertex, the
/// others get new ones at the end, in the order of the vertices they double.
///
/// @param along  edges of the mesh, in any order; those that are none of it are passed over
void open_along(ShellMesh& mesh, const std::vector<Eigen::Vector2i>& along);

/// Whether the mesh is cut open: two of its vertices have the same place in the pattern.
bool has_lips(const ShellMesh& mesh);

/// Of each triangle the first one of the part that it holds together with over edges.
std::vector<int> parts(const Eigen::MatrixX3i& triangles);
/// Areas of such parts in the pattern, by their first triangles (m^2).
std::vector<double> part_areas(const ShellMesh& mesh);
/// Number of such parts.
int part_count(const Eigen::MatrixX3i& triangles);

}  // namespace geoprior::paper
