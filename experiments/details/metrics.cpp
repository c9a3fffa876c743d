#include <functional>
#include <memory>
#include <utility>
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

using SharedMemo = std::shared_ptr<DetailsMemo>;
using Rows = MetricRows<DetailsScene>;

constexpr Direction kLow = Direction::lower_is_better;
constexpr Direction kTarget = Direction::closer_to_target;
constexpr Direction kNone = Direction::none;

void add_spacing(Rows rows, const SharedMemo& memo) {
  const auto read = [memo](bool visible, auto get) {
    return [memo, visible, get](const DetailsScene& scene, const Frame& frame) -> Value {
      const SpacingPair pair = spacing_pair(*memo, scene, frame, visible);
      if (!(pair.rest.mean > 0) || pair.now.edges == 0) return {};
      return get(pair);
    };
  };
  using P = const SpacingPair&;
  const auto mean = [](P p) { return spacing_change(p.rest, p.now).mean; };
  rows.frame("mean_edge_change", "1",
             "relative change of the mean edge of M_d among details against rest, signed", kTarget,
             kShare, read(false, mean));
  rows.frame("visible_edge_change", "1",
             "the same for the mesh of the details of weight above 1/2: what one sees", kTarget,
             kShare, read(true, mean));
  const auto decile = [&](const char* name, const char* definition, std::size_t k) {
    rows.frame(name, "1", definition, kTarget, kShare,
               read(true, [k](P p) { return spacing_change(p.rest, p.now).deciles[k]; }));
  };
  decile("edge_change_p10", "relative change of the edge that a tenth of the visible fall below",
         0);
  decile("edge_change_p50", "relative change of the median edge of the visible details", 4);
  decile("edge_change_p90",
         "relative change of the edge that nine tenths of the visible fall below", 8);
  rows.frame("edge_variation", "1",
             "standard deviation of the edges of the visible details over their mean", kLow, kShare,
             read(true, [](P p) { return p.now.variation; }));
  rows.frame("smallest_edge", "1",
             "smallest edge of the visible details over the mean edge at rest",
             Direction::higher_is_better, {0.1, 0},
             read(true, [](P p) { return p.now.smallest / p.rest.mean; }));
  rows.frame("outside_share", "1",
             "share of the edges of the visible details outside 0.7 to 1.4 of the mean at rest",
             kLow, {0.03, 0}, read(true, [](P p) { return p.now.outside; }));
}

void add_density(Rows rows) {
  const auto ratio = [](bool visible) {
    return [visible](const DetailsScene& scene, const Frame& frame) -> Value {
      return details_over_wanted(scene, frame, visible);
    };
  };
  rows.frame("density_ratio", "1",
             "details over those at rest times the growth of the area under each", kTarget, kShare,
             ratio(false));
  rows.target(1);
  rows.frame("visible_density_ratio", "1", "the same for details of weight above 1/2", kTarget,
             kShare, ratio(true));
  rows.target(1);
  rows.frame("count_ratio", "1", "details over those at rest", kNone, kShare,
             [](const DetailsScene& scene, const Frame& frame) -> Value {
               return static_cast<double>(frame.require_part("details").points.rows()) /
                      static_cast<double>(scene.input.details.size());
             });
}

void add_pairs(Rows rows, const SharedMemo& memo) {
  const auto read = [memo](auto get) {
    return [memo, get](const DetailsScene& scene, const Frame& frame) -> Value {
      const auto pairs = pair_measures(*memo, scene, frame);
      return pairs ? get(*pairs) : Value();
    };
  };
  using P = const PairMeasures&;
  rows.frame("pair_distance", "1",
             "L1 distance of the pair correlation of the visible details to that of the original, "
             "along the surface, in the frames that scene.pair_frames chooses",
             kLow, {0.05, 0}, read([](P p) -> Value { return p.distance; }));
  rows.frame("pair_distance_naive", "1",
             "the same of the original details carried along: what doing nothing gives", kNone,
             kShare, read([](P p) -> Value { return p.naive; }));
  rows.frame("pair_noise", "1",
             "mean distance between the pair correlations of independent patterns of the process "
             "at rest: no distance below it means anything",
             kNone, kShare, read([](P p) { return p.noise; }));
  rows.frame("pair_distance_ratio", "1",
             "pair_distance over pair_distance_naive; absent where doing nothing is no further off "
             "than twice pair_noise",
             kLow, {0.05, 0}, read([](P p) -> Value {
               if (!(p.naive > 2 * p.noise.value_or(0))) return {};
               return p.distance / p.naive;
             }));
}

void add_spectrum(Rows rows, const SharedMemo& memo) {
  const auto read = [memo](auto get) {
    return [memo, get](const DetailsScene& scene, const Frame& frame) -> Value {
      const auto spectrum = spectrum_measures(*memo, scene, frame);
      return spectrum ? get(*spectrum) : Value();
    };
  };
  using S = const SpectrumMeasures&;
  rows.frame("spectrum_distance", "1",
             "integral of the difference of the radial power spectrum of the visible details and "
             "that of the original, in planes of at most 5,000 details, in the frames that "
             "scene.pair_frames chooses",
             kLow, {0.1, 0}, read([](S s) -> Value { return s.distance; }));
  rows.frame("spectrum_noise", "1",
             "mean of the same between the original and independent patterns of its process", kNone,
             kShare, read([](S s) { return s.noise; }));
  rows.frame("spectrum_elongation", "1",
             "how much of the power lies along one axis, mean up to 1.2 cycles a spacing: 0 for a "
             "pattern without direction, 1 for lines",
             kLow, {0.05, 0}, read([](S s) -> Value { return s.elongation; }));
}

void add_motion(Rows rows, const SharedMemo& memo) {
  const auto add = [&](const char* name, const char* definition, Direction direction,
                       Tolerance tolerance, auto get) {
    rows.sequence(name, "1", definition, direction, tolerance,
                  [memo, get](const DetailsScene& scene, const FrameSequence& frames) -> Value {
                    return get(motion_measures(*memo, scene, frames));
                  });
  };
  using M = const MotionMeasures&;
  add("worst_edge_change", "largest magnitude of mean_edge_change over the motion", kLow, kShare,
      [](M m) { return m.worst_edge_change; });
  add("worst_visible_change", "largest magnitude of visible_edge_change over the motion", kLow,
      kShare, [](M m) { return m.worst_visible_change; });
  add("weight_step",
      "largest change of a weight from one frame to the next; who is not there has 0", kLow,
      kRoundOff, [](M m) -> Value { return m.events.largest_step; });
  add("popping",
      "largest displacement of a detail's tip that the deformation does not explain, over the "
      "height of a detail",
      kLow, kShare, [](M m) { return m.popping; });
  add("inserted_total", "details that came over the motion", kNone, kCount,
      [](M m) -> Value { return m.events.inserted; });
  add("removed_total", "details that left over the motion", kNone, kCount,
      [](M m) -> Value { return m.events.removed; });
  add("churn", "insertions and removals that cancel each other", kLow, kCount,
      [](M m) -> Value { return m.events.churn; });
  add("turns", "times the number of details goes from growing to shrinking or back, by 1 % or more",
      kNone, {1, 0}, [](M m) -> Value { return m.turns; });
  add("events_at_rest",
      "insertions and details that begin to fade once the surface has not moved for ten frames",
      kLow, {0, 0}, [](M m) -> Value { return m.at_rest; });
}

}  // namespace

std::vector<MetricEntry> metrics() {
  const auto memo = std::make_shared<DetailsMemo>();
  std::vector<MetricEntry> table;
  const Rows rows(table);
  add_spacing(rows, memo);
  add_density(rows);
  add_pairs(rows, memo);
  add_spectrum(rows, memo);
  add_motion(rows, memo);
  return table;
}

}  // namespace geoprior::details
