#pragma once

#include <string>
#include <vector>

#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// What a drawing of several views is read with although its author hardly meant it, a line each:
///
/// - a surface without borders and seams: it is closed, and only cuts that the program chooses lay
///   it flat;
/// - a border of the front view at a height where the side view has none, or the other way round
///   (one line for all borders of a view when the other has none at all);
/// - front and side that fit each other far better when one is turned upside down: by their widths
///   at all heights, or by their borders.
/// @param aligned  of `align_views`
std::vector<std::string> doubtful_views(const Drawing& aligned);

}  // namespace geoprior::sketch
