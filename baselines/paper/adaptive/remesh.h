#pragma once

#include <vector>

#include "baselines/paper/adaptive/sizing.h"
#include "models/paper/sheet/sheet.h"

namespace geoprior::paper {

/// What one remeshing did.
struct RemeshReport {
  int splits = 0, collapses = 0, flips = 0;
  std::vector<bool> changed;  ///< of the new vertices: new, or with other triangles about it

  [[nodiscard]] bool any() const { return splits + collapses + flips > 0; }
};

/// Changes the triangulation of a sheet until its edges are as long as the sizing tensors ask
/// (Narain, Samii, O'Brien 2012):
///   1. flip edges that are not Delaunay in the tensors' metric (Bossen, Heckbert 1996),
///   2. split edges longer than 1 in it, the longest first, flipping about each,
///   3. collapse the shortest while all edges that result are shorter than 0.9, flipping likewise.
/// Border, handles' anchors and segments stay; triangles never turn over in the pattern; a fold of
/// more than 40 degrees is never flipped. Ties are decided by index.
///
/// @param state   of a sheet with this pattern; replaced when something changed
/// @param sizes   of its vertices
RemeshReport remesh(const Sheet& sheet, const std::vector<SizeTensor>& sizes, ShellState& state);

}  // namespace geoprior::paper
