#pragma once

#include <memory>

#include "core/frame.h"
#include "core/method.h"
#include "solvers/sketch/one_view.h"

namespace geoprior::sketch {

/// One recorded state of a reconstruction from one view:
///
/// - "surface" (triangles): point arrays "texture" (2, in the picture), "border", "seam", "fold"
/// (no
///   seams and folds are drawn: 0); cell arrays "patch", "mirror_image" (0 or 1);
/// - "strokes" (lines): drawn borders in space; point arrays "stroke" (of the view) and "drawn_at"
/// (point
///   of the stroke, with its fraction);
/// - "rulings" (lines).
///
/// Diagnostics: residual of every term of the energy [m], condition, matches.
Frame one_view_frame(const OneViewResult& result);

/// A single frame: `reconstruct_one_view`, phase "reconstruct".
std::unique_ptr<Process> make_one_view_process(const View& view, const OneViewOptions& options);

}  // namespace geoprior::sketch
