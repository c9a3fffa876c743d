#include <functional>
#include <optional>
#include <vector>

#include "experiments/sketch/measures.h"
#include "experiments/sketch/topic.h"
#include "testbed/metric_rows.h"

namespace geoprior::sketch {
namespace {

// Runs of one build are equal bit for bit; tolerances are for other compilers and processors, where
// another edge may be chosen for a silhouette.
constexpr Tolerance kSum{1e-6, 0.02};
constexpr Tolerance kShare{0.005, 0};
constexpr Tolerance kCount{0, 0};
constexpr Tolerance kPercent{0.02, 0.02};

constexpr Direction kLow = Direction::lower_is_better;
constexpr Direction kHigh = Direction::higher_is_better;
constexpr Direction kNone = Direction::none;

MetricGroup surface_group() {
  using M = const SurfaceMeasures&;
  return frame_metrics<SketchScene>(surface_measures)
      .row("angle_defect_sum", "rad",
           "sum of |angle defect| over the interior vertices; at least 4 pi on a closed surface "
           "without handles",
           kLow, kSum, [](M m) { return m.all.defect_sum; })
      .row("angle_defect_median", "rad", "median of |angle defect| over the interior vertices",
           kLow, kSum, [](M m) { return m.all.defect_median; })
      .row("angle_defect_max", "rad", "largest |angle defect| of an interior vertex", kLow,
           {1e-6, 0.05}, [](M m) { return m.all.defect_max; })
      .row("flat_share", "1", "share of the interior vertices with |angle defect| below 0.005 rad",
           kHigh, kShare, [](M m) { return m.all.defect_flat_share; })
      .row("stein_energy", "rad",
           "sum over the interior vertices of the smallest eigenvalue of sum theta n n' over the "
           "star (Stein, Grinspun and Crane 2018)",
           kLow, kSum, [](M m) { return m.all.hinge_sum; })
      .row("panel_defect_sum", "rad", "angle_defect_sum without the vertices of seams and folds",
           kLow, kSum, [](M m) { return m.panels.defect_sum; })
      .row("panel_stein_energy", "rad", "stein_energy without the vertices of seams and folds",
           kLow, kSum, [](M m) { return m.panels.hinge_sum; });
}

MetricGroup silhouette_group() {
  using M = SilhouetteMeasures;
  return frame_metrics<SketchScene>(silhouette_measures)
      .row("silhouette_iou", "1",
           "intersection over union of the surface's projection and the drawn silhouette, of all "
           "views the worst",
           kHigh, {5e-4, 0}, &M::iou)
      .row("silhouette_hausdorff", "%",
           "Hausdorff distance of the two outlines over the diagonal of the drawing's box, of all "
           "views the worst",
           kLow, kPercent, &M::hausdorff_percent)
      .row("silhouette_gaps", "1",
           "share of the drawn silhouette that is farther than half a percent of the diagonal from "
           "the surface's outline, of all views the worst",
           kLow, kShare, &M::gap_share);
}

/// A row that is read off the flattening of frames with a pattern.
template <class Read>
auto of_flat(Read read) {
  return [read](const PatternMeasures& m) -> std::optional<double> {
    if (!m.flat) return {};
    return static_cast<double>(read(*m.flat));
  };
}

MetricGroup pattern_group() {
  using F = const FlatteningSummary&;
  using M = PatternMeasures;
  return frame_metrics<SketchScene>(pattern_measures)
      .row("stretch_mean", "1",
           "mean by area of max(s1, 1 / s2), s1 >= s2 the singular values from the surface to the "
           "pattern at true scale",
           kLow, {1e-4, 0}, of_flat([](F f) { return f.stretch_mean; }))
      .row("stretch_p95", "1", "what 95 % of the area stay under", kLow, {1e-3, 0},
           of_flat([](F f) { return f.stretch_p95; }))
      .row("stretch_share_1", "1", "share of the area that is stretched by less than 1 %", kHigh,
           {0.02, 0}, of_flat([](F f) { return f.stretch_share[0]; }))
      .row("stretch_share_2", "1", "share of the area that is stretched by less than 2 %", kHigh,
           {0.02, 0}, of_flat([](F f) { return f.stretch_share[1]; }))
      .row("stretch_share_5", "1", "share of the area that is stretched by less than 5 %", kHigh,
           {0.02, 0}, of_flat([](F f) { return f.stretch_share[2]; }))
      .row("area_ratio", "1", "area of the pattern over that of the surface", kNone, {1e-3, 0},
           of_flat([](F f) { return f.area_ratio; }))
      .row("sander_l2", "1", "Sander's L2 stretch from the pattern to the surface, not rescaled",
           kLow, {1e-3, 0}, of_flat([](F f) { return f.sander_l2; }))
      .row("flips", "1", "triangles turned over in the pattern", kLow, kCount,
           of_flat([](F f) { return f.flips; }))
      .row("self_overlaps", "1", "pairs of triangles of one piece that overlap in the pattern",
           kLow, kCount, of_flat([](F f) { return f.self_overlaps; }))
      .row("pieces", "1", "pieces of the pattern", kNone, kCount, &M::pieces)
      .row("piece_overlaps", "1", "pairs of pieces that overlap in the layout", kLow, kCount,
           &M::piece_overlaps)
      .row("seam_mismatch", "1",
           "largest difference of the lengths of two stretches that are sewn together, over their "
           "mean",
           kLow, {1e-3, 0.05}, &M::seam_mismatch);
}

MetricGroup truth_group() {
  using M = TruthMeasures;
  return frame_metrics<SketchScene>(truth_measures)
      .row("depth_rms", "1",
           "root mean square error of the depth of drawn borders over the height of the shape, "
           "without its mean, which one view cannot tell",
           kLow, {1e-4, 0.02}, &M::depth_rms)
      .row("depth_max", "1", "the largest such error", kLow, {1e-3, 0.05}, &M::depth_max)
      .row("reprojection", "1",
           "root mean square distance in the view from where the borders really are, over the "
           "width of the drawing",
           kLow, {1e-5, 0.02}, &M::reprojection)
      .row("pattern_area_error", "1",
           "difference of the pattern's area from that of the known panels, over the latter", kLow,
           {1e-3, 0.05}, &M::pattern_area)
      .row("panel_area_error", "1", "the same of the panel that is farthest off", kLow,
           {1e-3, 0.05}, &M::panel_area);
}

}  // namespace

std::vector<MetricGroup> metrics() {
  return {surface_group(), silhouette_group(), pattern_group(), truth_group()};
}

}  // namespace geoprior::sketch
