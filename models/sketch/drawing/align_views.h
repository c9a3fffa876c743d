#pragma once

#include <string>
#include <vector>

#include "core/options.h"
#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// How far views of one object may disagree.
struct AlignOptions {
  double tolerance = 0.05;  ///< of the extents along an axis that two views share
};
void describe(OptionVisitor& v, AlignOptions& options);

/// Puts the views of a drawing into one frame: x about 0, y from 0 up, z about 0 (m).
///
/// Views are drawn anywhere on the page. The extents of their silhouettes along the axis that two
/// of them share (y of front and side, x of front and top, z of side and top) must agree within
/// `tolerance`; what is left of a difference is taken out by scaling the later view along that
/// axis. This is the test that the snapping lines of the thesis' interface make while one draws.
///
/// Strokes of all kinds move with their view; a view `photo` is left as it is.
/// @throws Error  when two views have different extents (names both, and by how much), or a view
/// has
///                no silhouette
/// @param warnings  gets a line for each view that was scaled by more than a percent; null: none
Drawing align_views(const Drawing& drawing, const AlignOptions& options = {},
                    std::vector<std::string>* warnings = nullptr);

}  // namespace geoprior::sketch
