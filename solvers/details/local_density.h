#pragma once

#include "models/details/mesh.h"

namespace geoprior::details {

/// Gives every triangle of M_d the density of details around it in place of its own: that of a
/// detail is (number of triangles / 2) / area over its star (triangles with ghosts left out), then
/// averaged `rounds` times over neighbours; a triangle takes the mean of its corners. Area against
/// this reference finds gaps and crowds with respect to the pattern's own density there, and the
/// sampling of a border does not matter.
void smooth_densities(DetailMesh& details, int rounds);

}  // namespace geoprior::details
