#pragma once

#include <memory>

#include "core/options.h"
#include "models/sketch/sketch_process.h"

namespace geoprior::sketch {

struct HullSurfaceOptions {
  bool smoothed = false;  ///< as the methods begin
};
void describe(OptionVisitor& v, HullSurfaceOptions& options);

/// What the thesis' method begins with, laid flat: the visual hull, which has the silhouettes and
/// sharp edges between the views' faces, or the same smoothed (Taubin 1995), which has neither. One
/// frame.
std::unique_ptr<Process> make_hull_process(const SketchInput& input,
                                           const HullSurfaceOptions& options);

}  // namespace geoprior::sketch
