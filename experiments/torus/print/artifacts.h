#pragma once

#include <optional>
#include <vector>

#include "core/frame.h"
#include "core/method.h"
#include "models/torus/input.h"

namespace geoprior::torus {

/// A body to be printed.
struct PrintedBody {
  double size = 0.1;     ///< largest side of the surface's box (m)
  double thickness = 0;  ///< of the wall (m); 0: a whole torus is solid
};

/// Files beside the last frame: `surface.stl` and `surface.glb` where a body is asked for, which
/// becomes the part "print" of the frame (m); `grid.vti` of the part "grid", which leaves it.
/// @throws Error  where the wall leaves no cavity
std::vector<Artifact> artifacts_of(const TorusInput& input,
                                   const std::optional<PrintedBody>& printed, Frame& frame);

}  // namespace geoprior::torus
