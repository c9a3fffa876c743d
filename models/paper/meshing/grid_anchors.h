#pragma once

#include <vector>

#include "models/paper/sheet/pattern.h"
#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// The same mesh with a vertex at every anchor: the nearest vertex moves there where triangles keep
/// a good shape, otherwise the anchor becomes a new vertex and the triangles about it are made
/// anew.
/// @param anchors  points of the pattern, no two within the rounding of its width
ShellMesh with_anchors(ShellMesh mesh, const Pattern& pattern,
                       const std::vector<Eigen::Vector2d>& anchors);

}  // namespace geoprior::paper
