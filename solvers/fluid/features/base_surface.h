#pragma once

#include <vector>

#include "core/mesh.h"

namespace geoprior::fluid {

/// The smooth bed under a region: vertices of `inside` move so that the bi-Laplacian of their
/// positions vanishes, L M^-1 L x = 0, the rest stays (two rings of it are the boundary condition:
/// position and slope). Same connectivity.
///
/// L is the cotangent Laplacian of the surface as it is, M the barycentric mass; cotangents are
/// clamped to ±20 and masses to 1 % of their mean, against slivers of contouring. Vertices on a
/// border of the mesh stay. Linear solve: sparse Cholesky.
///
/// @param inside  1 for vertices that move, one per vertex
/// @return positions; those outside are unchanged. @throws Error when a component has no vertex
/// that stays, or the system is singular (names a vertex)
/// Source: Botsch and Kobbelt 2004b; thesis 3.3.1 (smooth underlying surface).
Eigen::MatrixX3d base_under(const TriMesh& mesh, const std::vector<char>& inside);

/// `base_under`, and where its triangles fold over in the plane across their mean normal (a surface
/// more than three times as long as its bed), coordinates in that plane are replaced by harmonic
/// ones (weights positive: no folds for a convex region). Heights stay.
Eigen::MatrixX3d unfolded_base(const TriMesh& mesh, const std::vector<char>& inside);

}  // namespace geoprior::fluid
