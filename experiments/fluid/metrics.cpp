#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "experiments/fluid/measures.h"
#include "experiments/fluid/topic.h"
#include "metrics/dam_break.h"
#include "metrics/seam.h"
#include "metrics/self_contact.h"
#include "metrics/slosh.h"
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

using SharedMemo = std::shared_ptr<FluidMemo>;
using Rows = MetricRows<FluidScene>;

void add_surface(Rows rows, const SharedMemo& memo) {
  const auto read = [memo](auto get) {
    return [memo, get](const FluidScene& scene, const Frame& frame) -> Value {
      return get(liquid_measures(*memo, scene, surface_part(frame)));
    };
  };
  using M = const LiquidMeasures&;
  rows.frame("volume", "m^3", "volume that the surface encloses; absent when it is not closed",
             Direction::none, kChaotic, read([](M m) { return m.volume; }));
  rows.frame("potential_energy", "J",
             "of the enclosed liquid above z = 0; absent when the surface is not closed",
             Direction::none, kChaotic, read([](M m) { return m.potential_energy; }));
  rows.frame("border_edges", "1", "edges of one triangle only: 0 on a closed surface",
             Direction::none, kExact, read([](M m) -> Value { return m.closed.border_edges; }));
  rows.frame(
      "manifold_defects", "1",
      "edges of three or more triangles or of two that are oppositely oriented, and vertices "
      "where two sheets touch",
      Direction::lower_is_better, kExact, read([](M m) -> Value {
        return m.closed.crowded_edges + m.closed.turned_edges + m.closed.pinched_vertices;
      }));
  rows.frame("components", "1", "connected pieces of the surface", Direction::none, kCount,
             read([](M m) -> Value { return m.closed.components; }));
  rows.frame("top", "m", "height of the highest point", Direction::none, kChaotic,
             read([](M m) -> Value { return m.top; }));
  rows.frame("triangles", "1", "triangles of the surface", Direction::none, kCount,
             [](const FluidScene&, const Frame& frame) -> Value {
               return static_cast<double>(surface_part(frame).triangles.rows());
             });
  rows.frame("seam_angle", "deg",
             "largest angle between the normals of two triangles on both sides of the border of "
             "what features moved",
             Direction::lower_is_better, kChaotic,
             [](const FluidScene&, const Frame& frame) -> Value {
               const Part& surface = surface_part(frame);
               const NamedArray* feature = surface.find_array("feature");
               if (feature == nullptr) return {};
               std::vector<char> moved(surface.points.rows());
               for (std::size_t v = 0; v < moved.size(); ++v) {
                 moved[v] = feature->values(static_cast<Eigen::Index>(v), 0) != 0 ? 1 : 0;
               }
               return largest_seam_angle({surface.points, surface.triangles}, moved) * 180 /
                      std::numbers::pi;
             });
  rows.frame("intersecting_pairs", "1",
             "pairs of triangles that intersect, of surfaces that features were pasted into",
             Direction::lower_is_better, kCount,
             [](const FluidScene&, const Frame& frame) -> Value {
               const Part& surface = surface_part(frame);
               if (surface.find_array("feature") == nullptr) return {};
               return intersecting_pairs(surface.points, surface.triangles);
             });
}

void add_dam_break(Rows rows, const SharedMemo& memo) {
  const auto read = [memo](auto get) {
    return [memo, get](const FluidScene& scene, const Frame& frame) -> Value {
      const std::optional<DamMeasures> dam = dam_measures(*memo, scene, frame);
      if (!dam) return {};
      const double value = get(*dam);
      return std::isfinite(value) ? Value(value) : Value();
    };
  };
  using D = const DamMeasures&;
  rows.frame("dam_front", "1",
             "place of the surge front, x / a: where the mean column is deeper than half a cell; "
             "scenes with one block of water at the wall",
             Direction::none, kChaotic, read([](D d) { return d.front; }));
  rows.frame("dam_height", "1", "height of the water at the wall over that of the block",
             Direction::none, kChaotic, read([](D d) { return d.height; }));
  rows.frame("dam_front_error", "1",
             "dam_front over the one that Martin and Moyce measured at that time, minus 1",
             Direction::closer_to_target, kChaotic, read([](D d) {
               return d.front / interpolate(measured_dam_front(), d.front_time) - 1;
             }));
  rows.frame("dam_height_error", "1",
             "dam_height minus the one that Martin and Moyce measured at that time, in heights of "
             "the block",
             Direction::closer_to_target, kChaotic, read([](D d) {
               return d.height - interpolate(measured_dam_height(), d.height_time);
             }));
}

void add_comparison(Rows rows, const SharedMemo& memo) {
  rows.pair("distance_rms", "m",
            "RMS distance of the surface from the reference's, both ways, the larger",
            Direction::lower_is_better, kChaotic,
            [memo](const FluidScene& s, const Frame& f, const Frame& r) -> Value {
              return std::max(deviation_from(*memo, s, f, r).rms,
                              deviation_of_reference(*memo, s, f, r).rms);
            });
  rows.pair("distance_max", "m", "Hausdorff distance of the surface and the reference's",
            Direction::lower_is_better, kChaotic,
            [memo](const FluidScene& s, const Frame& f, const Frame& r) -> Value {
              return std::max(deviation_from(*memo, s, f, r).max,
                              deviation_of_reference(*memo, s, f, r).max);
            });
  const auto compare = [memo](auto get) {
    return [memo, get](const FluidScene& s, const Frame& f, const Frame& r) -> Value {
      const LiquidMeasures a = liquid_measures(*memo, s, surface_part(f));
      const LiquidMeasures b = liquid_measures(*memo, s, surface_part(r));
      if (!a.columns || !b.columns) return {};
      return get(compare_columns(a.columns->top, b.columns->top));
    };
  };
  rows.pair("height_rms", "m", "RMS difference of the highest points at wave gauges a cell apart",
            Direction::lower_is_better, kChaotic,
            compare([](const ColumnComparison& c) -> Value { return c.rms; }));
  rows.pair("height_correlation", "1", "correlation of the highest points at the gauges",
            Direction::higher_is_better, {0.05, 0},
            compare([](const ColumnComparison& c) -> Value { return c.correlation; }));
  rows.pair("volume_change", "1", "volume over the reference's, minus 1",
            Direction::closer_to_target, {1e-4, 0.1},
            [memo](const FluidScene& s, const Frame& f, const Frame& r) -> Value {
              const Value a = liquid_measures(*memo, s, surface_part(f)).volume;
              const Value b = liquid_measures(*memo, s, surface_part(r)).volume;
              if (!a || !b || *b == 0) return {};
              return *a / *b - 1;
            });
}

/// Largest |V - V0| / V0 of the frames; absent when a frame is not closed or liquid is poured in.
Value volume_drift(FluidMemo& memo, const FluidScene& scene, const FrameSequence& frames) {
  if (!scene.tank || !scene.tank->sources.empty()) return {};
  Value first;
  double drift = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto surface = frames.part(i, "surface");
    if (!surface) return {};
    const Value volume = liquid_measures(memo, scene, *surface).volume;
    if (!volume || (first && *first == 0)) return {};
    if (!first) first = volume;
    drift = std::max(drift, std::abs(*volume / *first - 1));
  }
  return first ? Value(drift) : Value();
}

/// Frequency of the first standing wave against linear theory, for one half space of water that
/// starts tilted in a closed tank.
Value slosh_frequency_error(FluidMemo& memo, const FluidScene& scene, const FrameSequence& frames) {
  if (!scene.tank || !scene.tank->solids.empty() || !scene.tank->sources.empty()) return {};
  const std::vector<LiquidVolume>& volumes = scene.tank->volumes;
  if (volumes.size() != 1 || volumes.front().shape.kind != LiquidShape::Kind::half_space) return {};
  std::vector<double> swing;
  double depth = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto surface = frames.part(i, "surface");
    if (!surface) return {};
    const LiquidMeasures m = liquid_measures(memo, scene, *surface);
    if (!m.columns) return {};
    swing.push_back(slosh_amplitude(*m.columns, *scene.gauges));
    if (i == 0) depth = m.columns->depth.mean();
  }
  const double measured = crossing_frequency(frames.parameters(), swing);
  const double length = scene.tank->cells.x() * scene.tank->cell;
  const double expected = slosh_frequency(length, depth, scene.gravity.norm());
  if (measured == 0 || expected == 0) return {};
  return std::abs(measured / expected - 1);
}

void add_time(Rows rows, const SharedMemo& memo) {
  rows.sequence("volume_drift", "1",
                "largest change of the enclosed volume from the first frame's, relative",
                Direction::lower_is_better, kChaotic,
                [memo](const FluidScene& scene, const FrameSequence& frames) {
                  return volume_drift(*memo, scene, frames);
                });
  rows.sequence("slosh_frequency_error", "1",
                "error of the frequency of the first standing wave along x against sqrt(g k tanh(k "
                "H)), k = pi / L; scenes with one tilted half space of water",
                Direction::lower_is_better, {5e-3, 0},
                [memo](const FluidScene& scene, const FrameSequence& frames) {
                  return slosh_frequency_error(*memo, scene, frames);
                });
  rows.sequence("second_difference", "m",
                "largest second difference in time of the heights at the gauges, a frame apart",
                Direction::lower_is_better, kChaotic,
                [](const FluidScene& scene, const FrameSequence& frames) {
                  return second_difference(scene, frames, false).pasted;
                });
  rows.sequence("seam_jitter", "1",
                "second_difference of the largest piece of the surface where the seams of features "
                "pass, over that of the target alone at the same gauges and times",
                Direction::lower_is_better, kChaotic,
                [](const FluidScene& scene, const FrameSequence& frames) -> Value {
                  const SecondDifference d = second_difference(scene, frames, true);
                  if (!d.pasted || !d.target || *d.target == 0) return {};
                  return *d.pasted / *d.target;
                });
}

/// Largest error of any mode in any three frames in a row.
Value sea_dispersion(const FrameSequence& frames) {
  Eigen::MatrixXcd modes[3];
  Value worst;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::optional<SeaState> sea = sea_state(*frames.frame(i));
    if (!sea) return {};
    modes[0] = std::move(modes[1]);
    modes[1] = std::move(modes[2]);
    modes[2] = fourier_modes(sea->heights);
    if (i < 2) continue;
    const double interval = (frames.parameter(i) - frames.parameter(i - 2)) / 2;
    const DispersionError error =
        dispersion_error(modes[0], modes[1], modes[2], interval, sea->patch);
    if (error.modes > 0) worst = std::max(worst.value_or(0), error.max);
  }
  return worst;
}

void add_sea(Rows rows) {
  const auto read = [](auto get) {
    return [get](const FluidScene&, const Frame& frame) -> Value {
      const std::optional<SeaState> sea = sea_state(frame);
      return sea ? get(*sea) : Value();
    };
  };
  using S = const SeaState&;
  rows.frame("significant_wave_height", "m", "4 standard deviations of the heights of an ocean",
             Direction::none, kSmooth, read([](S s) -> Value {
               return 4 * std::sqrt(moments(s.heights.reshaped()).variance);
             }));
  rows.frame("variance_ratio", "1",
             "variance of an ocean's heights over what its spectrum's modes carry on average",
             Direction::closer_to_target, kSmooth, read([](S s) -> Value {
               if (s.expected_variance == 0) return {};
               return moments(s.heights.reshaped()).variance / s.expected_variance;
             }));
  rows.target(1);
  rows.frame("kurtosis", "1", "of an ocean's heights; 3 for a Gaussian sea", Direction::none,
             kSmooth, read([](S s) -> Value { return moments(s.heights.reshaped()).kurtosis; }));
  rows.frame("downwind_share", "1", "share of the variance in waves that run with the wind",
             Direction::none, kSmooth, read([](S s) -> Value {
               return share_running_along(fourier_modes(s.heights), fourier_modes(s.rates), s.wind,
                                          s.patch);
             }));
  rows.sequence(
      "dispersion_error", "1",
      "largest relative error of a mode's frequency against sqrt(g k tanh(k H)), from "
      "three frames in a row",
      Direction::lower_is_better, kRoundOff,
      [](const FluidScene&, const FrameSequence& frames) { return sea_dispersion(frames); });
}

void add_tracking(Rows rows) {
  using T = const TrackingScores&;
  const auto add = [&](const char* name, const char* definition, Direction direction,
                       Tolerance tolerance, auto get) {
    rows.sequence(name, "1", definition, direction, tolerance,
                  [get](const FluidScene& scene, const FrameSequence& frames) -> Value {
                    const auto scores = scores_against_truth(scene, frames);
                    return scores ? Value(get(*scores)) : Value();
                  });
  };
  constexpr Direction kHigh = Direction::higher_is_better;
  constexpr Direction kLow = Direction::lower_is_better;
  constexpr Tolerance kShare{0.02, 0};
  add("idf1", "identity F1 of the tracks against the injected truth (Ristani et al. 2016)", kHigh,
      kShare, [](T t) { return t.idf1; });
  add("mota", "accuracy 1 - (misses + false alarms + switches) / true objects", kHigh, kShare,
      [](T t) { return t.mota; });
  add("hota", "higher-order tracking accuracy (Luiten et al. 2021)", kHigh, kShare,
      [](T t) { return t.hota; });
  add("track_precision", "share of the objects found that are true", kHigh, kShare,
      [](T t) { return t.precision; });
  add("track_recall", "share of the true objects that are found", kHigh, kShare,
      [](T t) { return t.recall; });
  add("track_fragments", "times that a true track's matches stop and begin again", kLow, kExact,
      [](T t) { return double(t.fragments); });
  add("track_switches", "times that a true track's match changes to another track", kLow, kExact,
      [](T t) { return double(t.switches); });
  add("lifetime_error", "mean error of a track's first and last frame together (frames)", kLow,
      {0.5, 0}, [](T t) { return t.lifetime_error; });
}

}  // namespace

std::vector<MetricEntry> metrics() {
  const auto memo = std::make_shared<FluidMemo>();
  std::vector<MetricEntry> table;
  const Rows rows(table);
  add_surface(rows, memo);
  add_dam_break(rows, memo);
  add_comparison(rows, memo);
  add_time(rows, memo);
  add_sea(rows);
  add_tracking(rows);
  return table;
}

}  // namespace geoprior::fluid
