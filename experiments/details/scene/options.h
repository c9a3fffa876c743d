#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "experiments/details/scene/deformation.h"
#include "experiments/details/scene/drawing_options.h"
#include "experiments/details/scene/handle_drag.h"
#include "experiments/details/scene/pattern.h"
#include "experiments/details/scene/surfaces.h"
#include "testbed/formats/sequence/files.h"

namespace geoprior::details {

/// `motion`: how the surface moves. Operations, on top of what handles drag; or a sequence.
struct DetailMotionOptions {
  int frames = 240;
  double duration = 1;
  std::vector<DeformationOptions> deform;
  std::optional<HandleDragOptions> drag;
  std::optional<SequenceOptions> sequence;
};
void describe(OptionVisitor& v, DetailMotionOptions& options);

/// `[scene]` of a details experiment.
struct DetailSceneOptions {
  DetailSurfaceOptions surface;
  DetailPatternOptions pattern;
  DetailMotionOptions motion;
  std::optional<double> detail_height;
  int pair_frames = 4;
  int pair_sources = 1000;
  std::optional<DetailDrawingOptions> drawing;
};
void describe(OptionVisitor& v, DetailSceneOptions& options);

}  // namespace geoprior::details
