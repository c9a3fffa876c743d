#include <memory>
#include <vector>

#include "experiments/details/measures.h"
#include "experiments/details/topic.h"
#include "testbed/metric_rows.h"

namespace geoprior::details {
namespace {

// Runs of one build are equal bit for bit; tolerances are for other compilers and processors, where
// a tie decided otherwise changes which detail comes, and little of what is measured of all.
constexpr Tolerance kShare{0.01, 0};
constexpr Tolerance kCount{3, 0.05};
constexpr Tolerance kRoundOff{1e-6, 0};
constexpr Tolerance kExact{0, 0};

constexpr Direction kLow = Direction::lower_is_better;
constexpr Direction kHigh = Direction::higher_is_better;
constexpr Direction kTarget = Direction::closer_to_target;
constexpr Direction kNone = Direction::none;

/// A group of metrics of the edges of "detail_mesh" or "visible_mesh".
auto spacing_metrics(const char* mesh) {
  return frame_metrics<DetailsScene>([mesh](const DetailsScene& scene, const Frame& frame) {
    return spacing_pair(scene, frame, mesh);
  });
}

MetricGroup spacing_group() {
  return spacing_metrics("detail_mesh")
      .row("mean_edge_change", "1",
           "relative change of the mean edge of M_d among details against rest, signed", kTarget,
           kShare, [](const SpacingPair& p) { return p.change.mean; });
}

MetricGroup visible_spacing_group() {
  using M = const SpacingPair&;
  return spacing_metrics("visible_mesh")
      .row("visible_edge_change", "1",
           "the same for the mesh of the details of weight above 1/2: what one sees", kTarget,
           kShare, [](M m) { return m.change.mean; })
      .row("edge_change_p10", "1",
           "relative change of the edge that a tenth of the visible fall below", kTarget, kShare,
           [](M m) { return m.change.deciles[0]; })
      .row("edge_change_p50", "1", "relative change of the median edge of the visible details",
           kTarget, kShare, [](M m) { return m.change.deciles[4]; })
      .row("edge_change_p90", "1",
           "relative change of the edge that nine tenths of the visible fall below", kTarget,
           kShare, [](M m) { return m.change.deciles[8]; })
      .row("edge_variation", "1",
           "standard deviation of the edges of the visible details over their mean", kLow, kShare,
           [](M m) { return m.now.variation; })
      .row("smallest_edge", "1", "smallest edge of the visible details over the mean edge at rest",
           kHigh, {0.1, 0}, [](M m) { return m.now.smallest / m.rest.mean; })
      .row("outside_share", "1",
           "share of the edges of the visible details outside 0.7 to 1.4 of the mean at rest", kLow,
           {0.03, 0}, [](M m) { return m.now.outside; });
}

MetricGroup density_group() {
  using M = DensityMeasures;
  return frame_metrics<DetailsScene>(density_measures)
      .row("density_ratio", "1",
           "details over those at rest times the growth of the area under each", kTarget, kShare,
           &M::all)
      .target(1)
      .row("visible_density_ratio", "1", "the same for details of weight above 1/2", kTarget,
           kShare, &M::visible)
      .target(1)
      .row("count_ratio", "1", "details over those at rest", kNone, kShare, &M::count);
}

MetricGroup pair_group() {
  using M = PairMeasures;
  const auto memo = std::make_shared<PairMemo>();
  return frame_metrics<DetailsScene>([memo](const DetailsScene& scene, const Frame& frame) {
           return pair_measures(*memo, scene, frame);
         })
      .row("pair_distance", "1",
           "L1 distance of the pair correlation of the visible details to that of the original, "
           "along the surface, in the frames that scene.pair_frames chooses",
           kLow, {0.05, 0}, &M::distance)
      .row("pair_distance_naive", "1",
           "the same of the original details carried along: what doing nothing gives", kNone,
           kShare, &M::naive)
      .row("pair_noise", "1",
           "mean distance between the pair correlations of independent patterns of the process "
           "at rest: no distance below it means anything",
           kNone, kShare, &M::noise)
      .row("pair_distance_ratio", "1",
           "pair_distance over pair_distance_naive; absent where doing nothing is no further off "
           "than twice pair_noise",
           kLow, {0.05, 0}, [](const M& m) -> Value {
             if (!(m.naive > 2 * m.noise.value_or(0))) return {};
             return m.distance / m.naive;
           });
}

MetricGroup spectrum_group() {
  using M = SpectrumMeasures;
  const auto memo = std::make_shared<SpectrumMemo>();
  return frame_metrics<DetailsScene>([memo](const DetailsScene& scene, const Frame& frame) {
           return spectrum_measures(*memo, scene, frame);
         })
      .row("spectrum_distance", "1",
           "integral of the difference of the radial power spectrum of the visible details and "
           "that of the original, in planes of at most 5,000 details, in the frames that "
           "scene.pair_frames chooses",
           kLow, {0.1, 0}, &M::distance)
      .row("spectrum_noise", "1",
           "mean of the same between the original and independent patterns of its process", kNone,
           kShare, &M::noise)
      .row("spectrum_elongation", "1",
           "how much of the power lies along one axis, mean up to 1.2 cycles a spacing: 0 for a "
           "pattern without direction, 1 for lines",
           kLow, {0.05, 0}, &M::elongation);
}

MetricGroup motion_group() {
  using M = MotionMeasures;
  return sequence_metrics<DetailsScene>(motion_measures)
      .row("worst_edge_change", "1", "largest magnitude of mean_edge_change over the motion", kLow,
           kShare, &M::worst_edge_change)
      .row("worst_visible_change", "1", "largest magnitude of visible_edge_change over the motion",
           kLow, kShare, &M::worst_visible_change)
      .row("weight_step", "1",
           "largest change of a weight from one frame to the next; who is not there has 0", kLow,
           kRoundOff, [](const M& m) { return m.events.largest_step; })
      .row("popping", "1",
           "largest displacement of a detail's tip that the deformation does not explain, over "
           "the height of a detail",
           kLow, kShare, &M::popping)
      .row("inserted_total", "1", "details that came over the motion", kNone, kCount,
           [](const M& m) { return m.events.inserted; })
      .row("removed_total", "1", "details that left over the motion", kNone, kCount,
           [](const M& m) { return m.events.removed; })
      .row("churn", "1", "insertions and removals that cancel each other", kLow, kCount,
           [](const M& m) { return m.events.churn; })
      .row("turns", "1",
           "times the number of details goes from growing to shrinking or back, by 1 % or more",
           kNone, {1, 0}, &M::turns)
      .row("events_at_rest", "1",
           "insertions and details that begin to fade once the surface has not moved for ten "
           "frames",
           kLow, kExact, [](const M& m) -> Value { return m.at_rest; });
}

MetricGroup drawn_popping_group() {
  return sequence_metrics<DetailsScene>(drawn_popping)
      .row("drawn_popping", "1/s",
           "largest displacement of the drawn surface (spikes, meshes, holes) from one frame to "
           "the next that the deformation does not explain, over the drawn size of a detail and "
           "the step in time, at the frames that scene.drawing.pop_frames chooses; sampled at all "
           "vertices and every size, over holes every quarter of it",
           kLow, {1e-3, 0.01});
}

}  // namespace

std::vector<MetricGroup> metrics() {
  return {spacing_group(),  visible_spacing_group(), density_group(),      pair_group(),
          spectrum_group(), motion_group(),          drawn_popping_group()};
}

}  // namespace geoprior::details
