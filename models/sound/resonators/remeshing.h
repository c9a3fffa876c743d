#pragma once

#include <vector>

#include "core/geometry/curvature_fit.h"
#include "models/sound/sheet.h"

namespace geoprior::sound {

/// A mesh of the pattern and how curvature is read from it.
struct FittedMesh {
  const ShellMesh& mesh;
  const CurvatureFit& fit;
};

/// Which triangles a change of the mesh has left alone, so that the curvature on them is read from
/// the same edges before and after: of each triangle of `now` the one of `before` with the same
/// corners in the pattern, bit for bit, of which the triangles whose edges its shape operator is
/// read from are the same ones, too; -1 where there is none. Numbers of vertices and triangles may
/// be others.
std::vector<int> kept_triangles(const FittedMesh& before, const FittedMesh& now);

}  // namespace geoprior::sound
