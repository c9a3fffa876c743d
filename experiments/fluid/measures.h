#pragma once

#include <optional>

#include "core/frame.h"
#include "experiments/fluid/scene/scene.h"
#include "metrics/isometry/seam.h"
#include "metrics/shape/surface_distance.h"
#include "metrics/tracks/scores.h"
#include "metrics/volume/closedness.h"
#include "metrics/volume/liquid_columns.h"
#include "metrics/volume/wave_modes.h"
#include "testbed/frame_sequence.h"

namespace geoprior::fluid {

/// What the groups of the fluid metric table (metrics.cpp) measure: quantities of one frame or
/// sequence, absent where they have no meaning.
using Value = std::optional<double>;

/// @throws Error  when the frame has no part "surface" of triangles
const Part& surface_part(const Frame& frame);

/// What one surface encloses, and whether it does.
struct LiquidMeasures {
  Closedness closed;
  Value volume;            ///< m^3, of closed surfaces
  Value potential_energy;  ///< J above z = 0, of closed surfaces
  double top = 0;          ///< highest point (m)
  Eigen::Index triangles = 0;
};
LiquidMeasures liquid_measures(const FluidScene& scene, const Frame& frame);

/// A surface that features were pasted into; absent for others.
struct PasteMeasures {
  double seam_angle = 0;  ///< rad: metrics/isometry/seam.h
  int intersecting_pairs = 0;
};
std::optional<PasteMeasures> paste_measures(const FluidScene& scene, const Frame& frame);

/// What differs between the sides of the border of what features moved, each continued by quadrics;
/// absent for other surfaces, and where no place of the border has quadrics on both sides.
std::optional<SeamJumps> paste_jumps(const FluidScene& scene, const Frame& frame);

/// Intersection over union of the inside of the surface and balls of half a cell about the
/// particles, as far as they are in the tank, along upright columns a quarter of a cell apart.
/// Absent without the part "particles" and for surfaces that are not closed.
Value particle_overlap(const FluidScene& scene, const Frame& frame);

/// Front Z = x / a and height H = h / (2a) of a dam break (metrics/volume/dam_break.h); absent for
/// scenes that are none.
struct DamMeasures {
  double front_time = 0, height_time = 0;  ///< T and tau
  double front = 0, height = 0;
  bool at_far_wall = false;  ///< within a cell: the front goes no further
};
std::optional<DamMeasures> dam_measures(const FluidScene& scene, const Frame& frame);

/// Distances of the surface from the reference's and of the reference's from it, the larger, at
/// points half a cell apart (m).
SurfaceDeviation surface_distance(const FluidScene& scene, const Frame& frame,
                                  const Frame& reference);

/// Highest points at the gauges against the reference's.
struct HeightMeasures {
  ColumnComparison columns;
  Value landed_rms;  ///< RMS difference, where the reference's surface is in one piece
};

/// Absent without gauges or surface.
std::optional<HeightMeasures> height_comparison(const FluidScene& scene, const Frame& frame,
                                                const Frame& reference);

/// Enclosed volume over the reference's, minus 1; absent when one of the two is not closed.
Value volume_change(const FluidScene& scene, const Frame& frame, const Frame& reference);

/// Of a tank without sources, over time; absent for other scenes.
struct TankMeasures {
  Value volume_drift;  ///< largest |V - V0| / V0; absent when a frame is not closed
  /// Of the frequency of the first standing wave against linear theory, for one half space of water
  /// that starts tilted in a tank without solids; absent for others.
  Value slosh_frequency_error;
};
std::optional<TankMeasures> tank_measures(const FluidScene& scene, const FrameSequence& frames);

/// The patch that ocean frames carry: modes of heights and rates.
struct SeaState {
  WavePatch patch;
  Eigen::Vector2d wind = Eigen::Vector2d::UnitX();
  double expected_variance = 0;
  Eigen::MatrixXd heights, rates;
};
std::optional<SeaState> sea_state(const Frame& frame);

/// Four standard deviations, variance over the expected, kurtosis and share along the wind of the
/// heights of an ocean; absent for frames that are none.
struct SeaMeasures {
  double significant_height = 0;  ///< m
  Value variance_ratio;           ///< absent where nothing is expected
  double kurtosis = 3;
  double downwind_share = 0;
};
std::optional<SeaMeasures> sea_measures(const FluidScene& scene, const Frame& frame);

/// Largest relative error of the frequency of any mode in any three frames in a row, of an ocean.
Value sea_dispersion(const FluidScene& scene, const FrameSequence& frames);

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
