#pragma once

#include <optional>

#include "experiments/embryo/frames/recorded.h"
#include "experiments/embryo/scene/scene.h"
#include "testbed/frame_sequence.h"

namespace geoprior::embryo {

/// How the structures move and grow from frame to frame.
struct MotionMeasures {
  std::optional<double> velocity_jump;  ///< over the mean speed; absent without border frames
  double reversals = 0;  ///< structures that lose volume, of those that are not said to regress
  std::optional<double> top_speed;  ///< m/d, of centres
};
MotionMeasures motion_measures(const EmbryoScene& scene, const FrameSequence& frames);

}  // namespace geoprior::embryo
