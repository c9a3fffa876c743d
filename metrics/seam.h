#pragma once

#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// Largest angle (radians, 0 to pi) between the normals of two triangles on both sides of a seam:
/// they share an edge, and one of them has a marked vertex while the other has none. 0 without a
/// seam. Triangles without area and edges of more than two triangles are left out.
///
/// @param marked  per vertex, not 0 where something was pasted
/// @throws Error  when `marked` is not as long as the mesh has vertices
double largest_seam_angle(const TriMesh& mesh, const std::vector<char>& marked);

}  // namespace geoprior
