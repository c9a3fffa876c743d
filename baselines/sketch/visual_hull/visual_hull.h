#pragma once

#include <memory>

#include "core/options.h"
#include "models/sketch/sketch_process.h"

namespace geoprior::sketch {

struct VisualHullOptions {
  bool smoothed = false;
  bool boxes = false;
};
void describe(OptionVisitor& v, VisualHullOptions& options);

/// What the thesis' method begins with, laid flat: the visual hull, which has the silhouettes and
/// sharp edges between the views' faces, or the same smoothed (Taubin 1995), which has neither. One
/// frame.
std::unique_ptr<Process> make_visual_hull_process(const SketchInput& input,
                                                  const VisualHullOptions& options);

}  // namespace geoprior::sketch
