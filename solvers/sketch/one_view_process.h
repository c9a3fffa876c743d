#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/method.h"
#include "models/sketch/pattern/make_pattern.h"
#include "solvers/sketch/one_view.h"

namespace geoprior::sketch {

/// Files made of a reconstruction, and what their making tells.
struct OneViewFiles {
  std::vector<Artifact> artifacts;
  std::map<std::string, double> diagnostics;
  std::map<std::string, Part> parts = {};  ///< that the frame has beside its own
};

/// What a reconstruction from one view is given.
struct OneViewInput {
  View view;
  PatternOptions pattern = {};
  bool patterns = true;  ///< whether the frame has the flat pieces
  /// Files that are made of the pieces; none when empty.
  std::function<OneViewFiles(const View&, const OneViewResult&, const Pattern&)> files = {};
};

/// One recorded state of a reconstruction from one view:
///
/// - "surface" (triangles): point arrays "texture" (2, in the picture), "border", "seam" (between
///   patches), "fold" (none is drawn: 0); cell arrays "patch", "mirror_image" (0 or 1), "panel"
///   (number of its name in `panels_of(view)`, -1 without one);
/// - "strokes" (lines): drawn borders in space; point arrays "stroke" (of the view) and "drawn_at"
///   (point of the stroke, with its fraction);
/// - "rulings" (lines);
/// - "pattern", "sewn" and the arrays that belong to them, as of several views
///   (models/sketch/sketch_process.h).
///
/// Diagnostics: residual of every term of the energy [m], condition, matches; of a refinement its
/// steps, the ratio of the plane vectors' lengths and the perspective that it found.
Frame one_view_frame(const View& view, const OneViewResult& result);

/// The edges between patches, along which the surface is cut into pieces; those between the same
/// two patches are one seam.
std::vector<SeamEdge> patch_seams(const TexturedSurface& surface);

/// A single frame: `reconstruct_one_view`, then its pieces laid flat. Patches that a seam closes in
/// a ring are cut open (`make_pattern`). Phases "reconstruct", "flatten", "record".
std::unique_ptr<Process> make_one_view_process(const OneViewInput& input,
                                               const OneViewOptions& options);

}  // namespace geoprior::sketch
