#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "core/mesh.h"

namespace geoprior::sketch {

/// Least squares conformal map with a free border.
///
/// Minimises sum_t area_t |d z / d conj(w)|^2 over all maps z of the disc with two pinned vertices,
/// w an isometric coordinate of triangle t. The pins are the two border vertices that lie farthest
/// apart in space, at that distance (`farthest_pair`); the result is scaled to the surface's area.
/// Angles are kept as well as they can be, lengths are not; triangles may turn over, and the map
/// depends on the pins where the surface is not developable.
///
/// @return        n x 2 (m)
/// @throws Error  unless the mesh is a disc
/// Source: Lévy, Petitjean, Ray, Maillot, Least Squares Conformal Maps, 2002.
Eigen::MatrixX2d flatten_lscm(const TriMesh& disc);

/// The two of some vertices that are farthest apart; of equal pairs the first. Quadratic.
std::array<int, 2> farthest_pair(const TriMesh& mesh, std::span<const int> vertices);

}  // namespace geoprior::sketch
