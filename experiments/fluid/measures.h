#pragma once

#include <limits>
#include <optional>
#include <string>

#include "core/frame.h"
#include "experiments/fluid/scene.h"
#include "metrics/closedness.h"
#include "metrics/liquid_columns.h"
#include "metrics/surface_distance.h"
#include "metrics/tracking_scores.h"
#include "metrics/wave_modes.h"
#include "testbed/frame_sequence.h"
#include "testbed/memo.h"

namespace geoprior::fluid {

/// What the rows of the fluid metric table (metrics.cpp) read: quantities of one frame or sequence,
/// absent where they have no meaning.
using Value = std::optional<double>;

/// @throws Error  when the frame has no part "surface" of triangles
const Part& surface_part(const Frame& frame);

/// Everything that is read off one surface.
struct LiquidMeasures {
  Closedness closed;
  Value volume;            ///< m^3, of closed surfaces
  Value potential_energy;  ///< J above z = 0, of closed surfaces
  double top = 0;          ///< highest point (m)
  std::optional<Columns> columns;
  double dam_front = std::numeric_limits<double>::quiet_NaN();  ///< m, of a dam break's scene
};

/// Values that the metrics of a frame share.
struct FluidMemo {
  Memo<LiquidMeasures, 8> surface;
  Memo<SurfaceDeviation, 8> forth, back;
};
LiquidMeasures liquid_measures(FluidMemo& memo, const FluidScene& scene, const Part& surface);

/// Distances of the surface from the reference's, at gauges half a cell apart (m).
SurfaceDeviation deviation_from(FluidMemo& memo, const FluidScene& scene, const Frame& frame,
                                const Frame& reference);
SurfaceDeviation deviation_of_reference(FluidMemo& memo, const FluidScene& scene,
                                        const Frame& frame, const Frame& reference);

/// Front Z = x / a and height H = h / (2a) of a dam break (metrics/dam_break.h).
struct DamMeasures {
  double front_time = 0, height_time = 0;  ///< T and tau
  double front = 0, height = 0;
};
std::optional<DamMeasures> dam_measures(FluidMemo& memo, const FluidScene& scene,
                                        const Frame& frame);

/// The patch that ocean frames carry: modes of heights and rates.
struct SeaState {
  WavePatch patch;
  Eigen::Vector2d wind = Eigen::Vector2d::UnitX();
  double expected_variance = 0;
  Eigen::MatrixXd heights, rates;
};
std::optional<SeaState> sea_state(const Frame& frame);

/// Largest second difference in time of the gauges' heights (m).
///
/// With `at_seam`, only gauges that a seam passes: a pasted gauge (under a vertex of the point
/// array "feature" that is not 0) beside one that is not; `target` is then the same of the target
/// alone, at the same gauges and times.
struct SecondDifference {
  Value pasted, target;
};
SecondDifference second_difference(const FluidScene& scene, const FrameSequence& frames,
                                   bool at_seam);

/// Tracks that the frames show (point arrays "track" and "kind" of the surface: area-weighted
/// centre and box of the vertices of a track) against the scene's injected truth. A match is within
/// four cells. Absent without a truth or without tracks.
std::optional<TrackingScores> scores_against_truth(const FluidScene& scene,
                                                   const FrameSequence& frames);

}  // namespace geoprior::fluid
