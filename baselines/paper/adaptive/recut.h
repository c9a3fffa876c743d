#pragma once

#include <vector>

#include "models/paper/sheet/pattern.h"
#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// Triangulates the vertices of a mesh anew, open along the cuts of a pattern that have grown since
/// it was made: constrained Delaunay. Vertices beside a cut, but for those on border, holes and
/// other cuts and the anchors, make room for it.
/// @param room  distance from the cuts within which vertices go (m)
ShellMesh recut(const ShellMesh& mesh, const Pattern& torn,
                const std::vector<Eigen::Vector2d>& anchors, double room);

}  // namespace geoprior::paper
