#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "experiments/details/scene/deformation.h"
#include "experiments/details/scene/drawing.h"
#include "experiments/details/scene/handle_drag.h"
#include "experiments/details/scene/pattern.h"
#include "experiments/details/scene/surfaces.h"
#include "testbed/formats/sequence/files.h"

namespace geoprior::details {

/// `motion`: how the surface moves. Operations, on top of what handles drag; or a sequence.
struct DetailMotionOptions {
  int frames = 240;     ///< after the first, which is the surface at rest
  double duration = 1;  ///< s
  std::vector<DeformationOptions> deform;
  std::optional<HandleDragOptions> drag;
  std::optional<SequenceOptions> sequence;  ///< instead of all above
};
void describe(OptionVisitor& v, DetailMotionOptions& options);

/// `[scene]` of a details experiment.
struct DetailSceneOptions {
  DetailSurfaceOptions surface;
  DetailPatternOptions pattern;
  DetailMotionOptions motion;
  std::optional<double> detail_height;  ///< of a detail of weight 1 (m)
  int pair_frames = 4;                  ///< at which the pair correlation is measured
  int pair_sources = 1000;              ///< details that distances are then measured from
  std::optional<DetailDrawingOptions> drawing;
};
void describe(OptionVisitor& v, DetailSceneOptions& options);

}  // namespace geoprior::details
