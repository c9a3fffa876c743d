#pragma once

#include <vector>

#include "core/mesh.h"
#include "core/rig.h"

namespace geoprior {

/// One step of Loop subdivision of the triangles marked in `refine` (empty: all), weights carried
/// along by the same stencils. The border of a region stays conforming: triangles beside it are
/// split to meet the new vertices.
RiggedMesh loop_subdivide(const RiggedMesh& rig, const std::vector<bool>& refine = {});

}  // namespace geoprior
