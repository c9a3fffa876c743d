#pragma once

#include <vector>

#include "models/embryo/body/day_state.h"
#include "models/embryo/surface/mesh.h"

namespace geoprior::embryo {

/// The surfaces of a day as the sharp union of their primitives: fused structures are min(f, g, …),
/// divided ones max(f, -slab), all by the same marching on the same lattices as `day_meshes`.
///
/// What it cannot do: where two structures meet stays a crease along which normals jump, and whose
/// edge the triangles cut off by up to half a box of the lattice.
/// Source: the union of constructive solid geometry, Ricci 1973; marching as in
/// models/embryo/surface/marching.h.
/// @param options  its `blend` is ignored
/// @throws Error  as `day_meshes` does
std::vector<StructureMesh> plain_union(const DayState& day, SurfaceOptions options = {});

}  // namespace geoprior::embryo
