#pragma once

#include <Eigen/Core>

#include "models/sketch/drawing/drawing.h"
#include "models/sketch/pattern/pattern.h"
#include "models/sketch/surface/sketch_surface.h"

namespace geoprior::sketch {

/// Names the pieces of a pattern, and the stretches of their borders, after what was drawn.
///
/// A border or seam names the pieces beside it by its `data-panel`: "front + back" on a seam are
/// the piece to its left on the page and the one to its right, above and below where it runs across
/// (inside and outside of a closed one); a single name is that of either. Every piece takes the
/// name that most of its border's length says. One that nothing names is called by the view that it
/// looks into: "front", "back", "left", "right" (the object's own), "top" or "bottom", where its
/// normals agree on one; else it keeps its name. Of several pieces of one name each gets its view
/// beside it, or its number where that does not tell them apart.
///
/// @param drawing   names of strokes
/// @param surface   whose seams, numbered in their order, and borders the pattern's edges are
/// @param X         n x 3, where its vertices are (m)
void name_pieces(Pattern& pattern, const Drawing& drawing, const SketchSurface& surface,
                 const Eigen::MatrixX3d& X);

}  // namespace geoprior::sketch
