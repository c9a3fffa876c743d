#include "experiments/torus/measures.h"
#include "experiments/torus/topic.h"
#include "testbed/metric_rows.h"

namespace geoprior::torus {
namespace {

// Runs of one build are equal bit for bit; tolerances are for other compilers and processors.
constexpr Tolerance kSmooth{1e-6, 1e-4};
constexpr Tolerance kExact{0, 0};
constexpr Direction kLow = Direction::lower_is_better;
constexpr Direction kTarget = Direction::closer_to_target;
constexpr Direction kNone = Direction::none;

MetricGroup default_group() {
  using M = DefaultMeasures;
  return frame_metrics<TorusScene>(default_measures)
      .row(
          "default_mean", "1",
          "mean of |Id - f* < , >| inside the windows, by differences of fourth order at 40 points "
          "a period of the finest corrugation, or at the method's grid",
          kLow, kSmooth, &M::mean)
      .row("default_max", "1", "largest |Id - f* < , >| inside the windows", kLow, kSmooth,
           &M::largest)
      .row("default_error", "1", "standard error of the mean over the windows", kNone, kSmooth,
           &M::deviation)
      .row("default_excess", "1",
           "the mean default less the mean |Id - h|, h the metric that the stage's corrugations "
           "would have made if each had added exactly its part (g_k once all three have)",
           kNone, kSmooth,
           [](const M& m) -> Value {
             if (!m.wanted) return std::nullopt;
             return m.mean - *m.wanted;
           })
      .row("default_miss", "1",
           "mean |h - f* < , >|: how far the metric is from that one; the excess is no larger",
           kLow, kSmooth, &M::miss);
}

MetricGroup coarse_group() {
  using M = CoarseMeasures;
  return frame_metrics<TorusScene>(coarse_measures)
      .row("default_8", "1",
           "mean default by differences of second order at 8 points a period: what a grid says",
           kNone, kSmooth, [](const M& m) { return m.mean[0]; })
      .row("default_16", "1", "the same at 16 points a period", kNone, kSmooth,
           [](const M& m) { return m.mean[1]; })
      .row("default_32", "1", "the same at 32 points a period", kNone, kSmooth,
           [](const M& m) { return m.mean[2]; });
}

MetricGroup corrugation_group() {
  using M = CorrugationMeasures;
  return frame_metrics<TorusScene>(corrugation_measures)
      .row("corrugation_error", "1",
           "mean of |f_before* + rho pi^2 / |pi|^2 - f*| inside the windows: what the last "
           "corrugation missed",
           kLow, kSmooth, &M::error)
      .row("corrugation_error_max", "1", "largest error inside the windows", kLow, kSmooth,
           &M::largest_error)
      .row("least_coefficient", "1",
           "smallest coefficient rho of the last corrugation inside the windows", kNone, kSmooth,
           &M::least_rho)
      .row("way", "m", "largest distance that the last corrugation moved a point of the windows",
           kNone, kSmooth, &M::way)
      .row("way_ratio", "1", "largest of it over its bound r / N", kNone, kSmooth, &M::way_ratio);
}

MetricGroup miss_group() {
  return sequence_metrics<TorusScene>(miss_ratio)
      .row("miss_ratio", "1",
           "default_miss after the last corrugation over the sum of the corrugation_errors of "
           "its stage",
           kLow, kSmooth);
}

MetricGroup length_group() {
  using M = LengthMeasures;
  return frame_metrics<TorusScene>(length_measures)
      .row("horizontal_length", "1", "length of a curve y = const over that in the square, 1",
           kTarget, kSmooth, &M::horizontal)
      .target(1)
      .row("vertical_length", "1", "length of a curve x = const over that in the square, 1",
           kTarget, kSmooth, &M::vertical)
      .target(1)
      .row("diagonal_length", "1", "length of a curve along (1, 2) over that in the square, sqrt 5",
           kTarget, kSmooth, &M::diagonal)
      .target(1);
}

MetricGroup normal_group() {
  using M = NormalMeasures;
  return frame_metrics<TorusScene>(normal_measures)
      .row("normal_power", "1",
           "mean square of the waves of the unit normal along a curve y = const in the band of the "
           "finest corrugation, between the geometric means of its number with its neighbours",
           kNone, kSmooth, &M::finest)
      .row("normal_slope", "1",
           "slope of log power over log number in these bands of all corrugations: 0 where each "
           "turns the normals as much as the one before, -2 for a surface of bounded curvature",
           kNone, kSmooth, &M::slope);
}

MetricGroup intersection_group() {
  using M = Intersections;
  return frame_metrics<TorusScene>(intersections)
      .row(
          "intersecting_pairs", "1",
          "pairs of triangles of the surface that intersect, where it has 8 points a period of the "
          "finest corrugation or more",
          kLow, kExact, &M::surface)
      .row("detail_intersecting_pairs", "1", "the same of the detail", kLow, kExact, &M::detail);
}

MetricGroup spread_group() {
  using M = NormalSpread;
  return frame_metrics<TorusScene>(normal_spread)
      .row("normal_spread", "deg",
           "root mean square angle of the triangles of the surface to their mean normal; absent "
           "where they cancel, as on a whole torus",
           kNone, kSmooth, &M::surface)
      .row("detail_spread", "deg", "the same of the detail", kNone, kSmooth, &M::detail);
}

MetricGroup print_group() {
  using M = PrintMeasures;
  return frame_metrics<TorusScene>(print_measures)
      .row(
          "print_defects", "1",
          "edges of the printed body of one triangle, of three and more, or of two that pass it in "
          "one direction, and pinched vertices: 0 where it is a closed manifold",
          kLow, kExact, &M::defects)
      .row("print_intersecting_pairs", "1", "pairs of triangles of the printed body that intersect",
           kLow, kExact, &M::intersecting)
      .row("print_volume", "m3", "volume of the printed body", kNone, kSmooth, &M::volume);
}

MetricGroup relief_group() {
  return frame_metrics<TorusScene>(relief).row(
      "relief", "m",
      "root mean square of the way from the torus of revolution to the points of the surface",
      kNone, kSmooth);
}

}  // namespace

std::vector<MetricGroup> metrics() {
  return {default_group(), coarse_group(), corrugation_group(),  miss_group(),
          length_group(),  normal_group(), intersection_group(), spread_group(),
          print_group(),   relief_group()};
}

}  // namespace geoprior::torus
