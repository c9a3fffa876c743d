#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/frame.h"
#include "experiments/details/scene.h"
#include "experiments/frame_sequence.h"
#include "experiments/memo.h"
#include "metrics/detail_continuity.h"
#include "metrics/detail_spacing.h"

namespace geoprior {

/// What the rows of the table of metrics (metrics.cpp) read: quantities of one frame or of a
/// motion, absent where they have no meaning.
using Value = std::optional<double>;

/// A part of a frame. @throws Error  when it has none of that name
const Part& required_part(const Frame& frame, const char* name);

/// Lengths of the edges of "detail_mesh" or "visible_mesh".
DetailSpacing spacing_of(const Part& mesh, double reference);

/// Values that the metrics of a frame share.
struct DetailsMemo {
  Memo<DetailSpacing, 16> spacing;
};

/// Spacing of all details ("detail_mesh") or of those that one sees ("visible_mesh"), in the frame
/// and at rest; `outside` is against the mean at rest.
struct SpacingPair {
  DetailSpacing rest, now;
};
SpacingPair spacing_pair(DetailsMemo& memo, const DetailsScene& scene, const Frame& frame,
                         bool visible);

/// Details over how many the surface asks for.
double details_over_wanted(const DetailsScene& scene, const Frame& frame, bool visible);

/// The largest change of the mean edge over a motion, in magnitude.
Value worst_edge_change(const DetailsScene& scene, const FrameSequence& frames, bool visible);

/// What happened to the details over a motion.
struct MotionMeasures {
  DetailEvents events;
  int turns = 0;               ///< of the number of details, by 1 % of the first or more
  Value popping;               ///< largest, over the height of a detail
  std::optional<int> at_rest;  ///< insertions and details that begin to fade while nothing moves
};
/// Frames count as at rest once the surface has not moved for ten frames: weights that change by a
/// tenth a frame are then done.
MotionMeasures motion_measures(const DetailsScene& scene, const FrameSequence& frames);

}  // namespace geoprior
