#pragma once

#include "core/mesh.h"
#include "models/embryo/body/day_state.h"
#include "models/embryo/shape/shape.h"

namespace geoprior::embryo {

/// A closed mesh of a solid whose connectivity depends on its primitive and the number of triangles
/// alone, so that the same vertex is the same place of the structure in every key frame: of an
/// ovoid a sphere of triangles that is scaled, of cylinders and ducts a tube with round caps, whose
/// rings are carried along the centre line without twist.
///
/// @param triangles  at least so many
/// @return           without triangles for points, lines and planes
TriMesh primitive_mesh(const Shape& shape, int triangles);

/// The same vertices and triangles for a product of a division: what is beyond the wall of the cut
/// is pressed flat onto it.
TriMesh half_mesh(const Half& half, int triangles);

}  // namespace geoprior::embryo
