#pragma once

#include "core/frame.h"
#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// All strokes of a drawing as lines in the plane z = 0, to be looked at: views side by side, the
/// side to the left of the front (both stand on one ground), the top to the right of it. Cell array
/// "kind" (StrokeKind).
Part drawing_part(const Drawing& drawing);

}  // namespace geoprior::sketch
