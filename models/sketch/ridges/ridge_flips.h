#pragma once

#include "core/mesh.h"

namespace geoprior::sketch {

/// Flips edges of a mesh until they run along its ridges: vertices stay, so that of the two
/// diagonals of a quadrangle the one along a ridge, both of whose ends lie on it, takes the place
/// of the one across it, which cuts a tooth into the ridge.
///
/// A flip is made where it lowers the turning sum l_e |theta_e| over the five edges of the two
/// triangles (twice the absolute mean curvature; Dyn, Hormann, Kim and Levin 2001), in passes over
/// the edges in their order until there is none, at most eight. The mesh stays a manifold, and no
/// triangle that it makes is thinner than a height of 0.3 of its longest edge. Needles, thinner
/// than 0.001, lose their longest edge in any case: three vertices of one ridge make one.
///
/// @param mesh  manifold, open or closed; its triangles change
/// @return      number of flips
int flip_to_ridges(TriMesh& mesh);

}  // namespace geoprior::sketch
