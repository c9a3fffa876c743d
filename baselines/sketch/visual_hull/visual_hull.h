#pragma once

#include <memory>
#include <optional>

#include "core/options.h"
#include "models/sketch/sketch_process.h"

namespace geoprior::sketch {

struct VisualHullOptions {
  bool smoothed = false;
  bool boxes = false;
  std::optional<int> double_steps = {};  ///< other than the scene's
  double rounded = 0;                    ///< radius in spacings of the hull's grid
};
void describe(OptionVisitor& v, VisualHullOptions& options);

/// What the thesis' method begins with, laid flat: the visual hull, which has the silhouettes and
/// sharp edges between the views' faces; the same smoothed (Taubin 1995), which has neither; or
/// with these edges rounded (`rounded_hull`). One frame.
std::unique_ptr<Process> make_visual_hull_process(const SketchInput& input,
                                                  const VisualHullOptions& options);

}  // namespace geoprior::sketch
