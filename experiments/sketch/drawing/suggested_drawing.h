#pragma once

#include <string>
#include <vector>

#include "models/sketch/drawing/drawing.h"
#include "models/sketch/pattern/suggested_seam.h"

namespace geoprior::sketch {

/// The drawing as SVG, its views side by side, with suggested cuts as seam strokes: every stretch
/// of a cut is in the view that sees it most squarely, with `data-depth` where that is from behind.
/// It is a drawing like any other (`read_drawing`): single strokes can be pasted into the original,
/// or taken out.
///
/// A stroke changes views as seldom as that allows: a change counts as much as a centimetre seen
/// edge on. Coordinates are rounded to a micrometre.
/// @param aligned  of `align_views`
std::string suggested_drawing_svg(const Drawing& aligned,
                                  const std::vector<SuggestedSeam>& suggestions);

}  // namespace geoprior::sketch
