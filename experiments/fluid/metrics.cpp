#include <cmath>
#include <numbers>
#include <vector>

#include "experiments/fluid/measures.h"
#include "experiments/fluid/topic.h"
#include "metrics/volume/dam_break.h"
#include "testbed/metric_rows.h"

namespace geoprior::fluid {
namespace {

// Runs of one build are equal bit for bit; tolerances are for other compilers and processors. A
// splash is chaotic: what is measured of it there may differ by what another seed would do.
constexpr Tolerance kSmooth{1e-9, 1e-3};
constexpr Tolerance kChaotic{1e-6, 0.1};
constexpr Tolerance kCount{2, 0.1};
constexpr Tolerance kExact{0, 0};
constexpr Tolerance kRoundOff{1e-7, 0};
constexpr Tolerance kShare{0.02, 0};

constexpr Direction kLow = Direction::lower_is_better;
constexpr Direction kHigh = Direction::higher_is_better;
constexpr Direction kTarget = Direction::closer_to_target;
constexpr Direction kNone = Direction::none;

/// Oracles: surfaces of particles and pasted ones are made closed 2-manifolds.
MetricGroup surface_group() {
  using M = const LiquidMeasures&;
  return frame_metrics<FluidScene>(liquid_measures)
      .row("volume", "m^3", "volume that the surface encloses; absent when it is not closed", kNone,
           kChaotic, [](M m) { return m.volume; })
      .row("potential_energy", "J",
           "of the enclosed liquid above z = 0; absent when the surface is not closed", kNone,
           kChaotic, [](M m) { return m.potential_energy; })
      .row("border_edges", "1", "edges of one triangle only: 0 on a closed surface", kNone, kExact,
           [](M m) { return m.closed.border_edges; })
      .oracle()
      .row("manifold_defects", "1",
           "edges of three or more triangles or of two that are oppositely oriented, and vertices "
           "where two sheets touch",
           kLow, kExact,
           [](M m) {
             return m.closed.crowded_edges + m.closed.turned_edges + m.closed.pinched_vertices;
           })
      .oracle()
      .row("components", "1", "connected pieces of the surface", kNone, kCount,
           [](M m) { return m.closed.components; })
      .row("top", "m", "height of the highest point", kNone, kChaotic, [](M m) { return m.top; })
      .row("triangles", "1", "triangles of the surface", kNone, kCount,
           [](M m) { return static_cast<double>(m.triangles); });
}

MetricGroup paste_group() {
  using M = const PasteMeasures&;
  return frame_metrics<FluidScene>(paste_measures)
      .row("seam_angle", "deg",
           "largest angle between the normals of two triangles on both sides of the border of "
           "what features moved",
           kLow, kChaotic, [](M m) { return m.seam_angle * 180 / std::numbers::pi; })
      .row("intersecting_pairs", "1",
           "pairs of triangles that intersect, of surfaces that features were pasted into", kLow,
           kCount, [](M m) { return m.intersecting_pairs; });
}

MetricGroup seam_jump_group() {
  using M = const SeamJumps&;
  const auto degrees = [](double radians) { return radians * 180 / std::numbers::pi; };
  return frame_metrics<FluidScene>(paste_jumps)
      .row("seam_position_jump", "m",
           "largest distance between the two sides of the border of what features moved, each "
           "continued by a quadric to the middle of an edge that crosses it",
           kLow, kChaotic, [](M m) { return m.largest.position; })
      .row("seam_position_rms", "m", "root mean square of the same over those edges", kLow,
           kChaotic, [](M m) { return m.rms.position; })
      .row("seam_angle_jump", "deg", "largest angle between the normals of the two sides there",
           kLow, kChaotic, [degrees](M m) { return degrees(m.largest.angle); })
      .row("seam_angle_rms", "deg", "root mean square of the same", kLow, kChaotic,
           [degrees](M m) { return degrees(m.rms.angle); })
      .row("seam_curvature_jump", "1/m",
           "largest difference between the mean curvatures of the two sides there", kLow, kChaotic,
           [](M m) { return m.largest.curvature; })
      .row("seam_curvature_rms", "1/m", "root mean square of the same", kLow, kChaotic,
           [](M m) { return m.rms.curvature; });
}

MetricGroup particle_group() {
  return frame_metrics<FluidScene>(particle_overlap)
      .row("particle_iou", "1",
           "volume that balls of half a cell about the particles, inside the tank, share with the "
           "inside of the surface, over that of either; frames that hold particles and a closed "
           "surface",
           kHigh, {1e-3, 0});
}

/// Absent where a front or a height could not be found.
std::optional<double> if_finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

MetricGroup dam_break_group() {
  using M = const DamMeasures&;
  return frame_metrics<FluidScene>(dam_measures)
      .row("dam_front", "1",
           "place of the surge front, x / a: where the mean column is deeper than half a cell; "
           "scenes with one block of water at the wall",
           kNone, kChaotic, [](M m) { return if_finite(m.front); })
      .row("dam_height", "1", "height of the water at the wall over that of the block", kNone,
           kChaotic, [](M m) { return if_finite(m.height); })
      .row("dam_front_error", "1",
           "dam_front over the one that Martin and Moyce measured at that time, minus 1; absent "
           "once the front is at the far wall",
           kTarget, kChaotic,
           [](M m) -> Value {
             if (m.at_far_wall) return {};
             return if_finite(m.front / interpolate(measured_dam_front(), m.front_time) - 1);
           })
      .row("dam_height_error", "1",
           "dam_height minus the one that Martin and Moyce measured at that time, in heights of "
           "the block",
           kTarget, kChaotic, [](M m) {
             return if_finite(m.height - interpolate(measured_dam_height(), m.height_time));
           });
}

MetricGroup distance_group() {
  return reference_metrics<FluidScene>({"surface"}, surface_distance)
      .row("distance_rms", "m",
           "RMS distance of the surface from the reference's, both ways, the larger", kLow,
           kChaotic, &SurfaceDeviation::rms)
      .row("distance_max", "m", "Hausdorff distance of the surface and the reference's", kLow,
           kChaotic, &SurfaceDeviation::max);
}

MetricGroup height_group() {
  using M = const HeightMeasures&;
  return reference_metrics<FluidScene>({"surface"}, height_comparison)
      .row("height_rms", "m", "RMS difference of the highest points at wave gauges a cell apart",
           kLow, kChaotic, [](M m) { return m.columns.rms; })
      .row("height_correlation", "1", "correlation of the highest points at the gauges", kHigh,
           {0.05, 0}, [](M m) { return m.columns.correlation; })
      .row("landed_height_rms", "m",
           "height_rms of the frames in which the reference's surface is in one piece: no drop is "
           "in the air",
           kLow, kChaotic, [](M m) { return m.landed_rms; });
}

MetricGroup volume_change_group() {
  return reference_metrics<FluidScene>({"surface"}, volume_change)
      .row("volume_change", "1", "volume over the reference's, minus 1", kTarget, {1e-4, 0.1});
}

MetricGroup tank_group() {
  return sequence_metrics<FluidScene>(tank_measures)
      .row("volume_drift", "1",
           "largest change of the enclosed volume from the first frame's, relative", kLow, kChaotic,
           &TankMeasures::volume_drift)
      .row("slosh_frequency_error", "1",
           "error of the frequency of the first standing wave along x against sqrt(g k tanh(k "
           "H)), k = pi / L; scenes with one tilted half space of water",
           kLow, {5e-3, 0}, &TankMeasures::slosh_frequency_error)
      .oracle();
}

MetricGroup second_difference_group() {
  return sequence_metrics<FluidScene>([](const FluidScene& scene, const FrameSequence& frames) {
           return second_difference(scene, frames, false).pasted;
         })
      .row("second_difference", "m",
           "largest second difference in time of the heights at the gauges, a frame apart", kLow,
           kChaotic);
}

MetricGroup seam_jitter_group() {
  return sequence_metrics<FluidScene>(
             [](const FluidScene& scene, const FrameSequence& frames) -> Value {
               const SecondDifference d = second_difference(scene, frames, true);
               if (!d.pasted || !d.target || *d.target == 0) return {};
               return *d.pasted / *d.target;
             })
      .row("seam_jitter", "1",
           "second_difference of the largest piece of the surface where the seams of features "
           "pass, over that of the target alone at the same gauges and times",
           kLow, kChaotic);
}

MetricGroup sea_group() {
  using M = SeaMeasures;
  return frame_metrics<FluidScene>(sea_measures)
      .row("significant_wave_height", "m", "4 standard deviations of the heights of an ocean",
           kNone, kSmooth, &M::significant_height)
      .row("variance_ratio", "1",
           "variance of an ocean's heights over what its spectrum's modes carry on average",
           kTarget, kSmooth, &M::variance_ratio)
      .target(1)
      .row("kurtosis", "1", "of an ocean's heights; 3 for a Gaussian sea", kNone, kSmooth,
           &M::kurtosis)
      .row("downwind_share", "1", "share of the variance in waves that run with the wind", kNone,
           kSmooth, &M::downwind_share);
}

MetricGroup dispersion_group() {
  return sequence_metrics<FluidScene>(sea_dispersion)
      .row("dispersion_error", "1",
           "largest relative error of a mode's frequency against sqrt(g k tanh(k H)), from "
           "three frames in a row",
           kLow, kRoundOff)
      .oracle();
}

MetricGroup tracking_group() {
  using M = TrackingScores;
  return sequence_metrics<FluidScene>(scores_against_truth)
      .row("idf1", "1",
           "identity F1 of the tracks against the injected truth (Ristani et al. 2016)", kHigh,
           kShare, &M::idf1)
      .row("mota", "1", "accuracy 1 - (misses + false alarms + switches) / true objects", kHigh,
           kShare, &M::mota)
      .row("hota", "1", "higher-order tracking accuracy (Luiten et al. 2021)", kHigh, kShare,
           &M::hota)
      .row("track_precision", "1", "share of the objects found that are true", kHigh, kShare,
           &M::precision)
      .row("track_recall", "1", "share of the true objects that are found", kHigh, kShare,
           &M::recall)
      .row("track_fragments", "1", "times that a true track's matches stop and begin again", kLow,
           kExact, &M::fragments)
      .row("track_switches", "1", "times that a true track's match changes to another track", kLow,
           kExact, &M::switches)
      .row("lifetime_error", "1", "mean error of a track's first and last frame together (frames)",
           kLow, {0.5, 0}, &M::lifetime_error);
}

}  // namespace

std::vector<MetricGroup> metrics() {
  return {surface_group(),     paste_group(),
          seam_jump_group(),   particle_group(),
          dam_break_group(),   distance_group(),
          height_group(),      volume_change_group(),
          tank_group(),        second_difference_group(),
          seam_jitter_group(), sea_group(),
          dispersion_group(),  tracking_group()};
}

}  // namespace geoprior::fluid
