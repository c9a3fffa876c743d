#pragma once

#include "core/mesh.h"

namespace geoprior {

/// Coarser version of a mesh by quadric edge collapse, for studies over the number of vertices.
///
/// Edges are collapsed in order of their error (sum of squared distances to the planes of the
/// triangles gathered so far, area weighted) until `target_vertices` are left. An edge is only
/// collapsed when the mesh stays manifold (link condition), no triangle turns by more than about
/// 80 degrees, and none becomes a sliver; so a closed manifold of any genus stays one of the same
/// genus, and the target may not be reached (the result says by its size). Borders are held by
/// planes through the border edges, upright on their triangles. Vertices without triangles are
/// dropped.
///
/// Weights are not carried along: compute them on the result (`heat_weights`).
///
/// @throws Error  for fewer than 4 target vertices or a non-manifold edge (names it)
/// Source: Garland and Heckbert 1997; link condition: Dey et al. 1999.
TriMesh simplify(const TriMesh& mesh, int target_vertices);

}  // namespace geoprior
