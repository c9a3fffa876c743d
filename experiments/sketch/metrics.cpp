#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/angles.h"
#include "experiments/sketch/garment_measures.h"
#include "experiments/sketch/layer_measures.h"
#include "experiments/sketch/measures.h"
#include "experiments/sketch/seam_measures.h"
#include "experiments/sketch/texture_measures.h"
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
           kLow, kSum, [](M m) { return m.panels.hinge_sum; })
      .row("sharp_turning", "1",
           "share of the turning, sum of length |angle between normals| over the interior edges "
           "that no seam or fold runs along, in edges that turn by more than 20 degrees",
           kLow, {0.005, 0}, [](M m) { return m.sharp_turning; })
      .row("crease_turning", "m",
           "integral, along the edges of creases off seams, borders, folds and drawn corners, of "
           "the "
           "angle beyond what edge length over local radius explains (rad m)",
           kLow, {1e-4, 0.03}, [](M m) { return m.crease.turning; })
      .row("crease_edges", "m",
           "length of these edges, which turn by more than 6 degrees beyond it", kLow, {1e-3, 0.03},
           [](M m) { return m.crease.length; })
      .row("crease_clean_length", "m",
           "length of those among them that follow each other smoothly, four or more between forks",
           kNone, {0.02, 0.05}, [](M m) { return m.crease.clean_length; })
      .row("crease_saw", "1", "share of crease_turning in all others: teeth", kLow, {0.03, 0},
           [](M m) { return m.crease.saw_share; })
      .row("crease_rest_p95", "deg",
           "angle beyond edge length over local radius that 95 % of the length of all edges stay "
           "under, off what was drawn as a crease",
           kLow, {0.05, 0.03}, [](M m) { return m.crease.rest_p95 / kDegree; })
      .row("crease_drawn", "m",
           "length of the edges along seams, folds and drawn corners, which may be creases", kNone,
           {1e-3, 0.02}, [](M m) { return m.drawn_length; });
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
    return read(*m.flat);
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

MetricGroup cut_group() {
  using M = CutMeasures;
  return frame_metrics<SketchScene>(cut_measures)
      .row(
          "seam_length", "m",
          "length on the surface of all cuts of the pattern: drawn seams, suggested ones that were "
          "applied, and what opens pieces that could not be laid flat",
          kLow, {1e-4, 0.02}, &M::seam_length)
      .row("suggestions", "1", "seams and darts that are suggested", kNone, kCount, &M::suggestions)
      .row("suggested_length", "m", "length of all suggested cuts together", kLow, {1e-4, 0.02},
           &M::suggested_length)
      .row("first_suggestion_length", "m", "length of the first of them", kLow, {1e-4, 0.02},
           &M::first_suggestion_length);
}

MetricGroup truth_group() {
  using M = TruthMeasures;
  return frame_metrics<SketchScene>(truth_measures)
      .row("depth_rms", "1",
           "root mean square error of the depth of drawn borders over the height of the shape, "
           "without its mean, which one view cannot tell",
           kLow, {1e-4, 0.02}, &M::depth_rms)
      .row("depth_max", "1", "the largest such error", kLow, {1e-3, 0.05}, &M::depth_max)
      .row("guessed_off", "1",
           "root mean square distance in space of points of borders that no stroke shows from the "
           "borders as they are, over the height of the shape",
           kLow, {1e-4, 0.02}, &M::guessed_off)
      .row("reprojection", "1",
           "root mean square distance in the view from where the borders really are, over the "
           "width of the drawing",
           kLow, {1e-5, 0.02}, &M::reprojection)
      .row("ruling_angle", "deg",
           "root mean square angle between a ruling and the generator of the cone through its "
           "middle",
           kLow, {1e-3, 0.05}, &M::ruling_angle)
      .row("pattern_area_error", "1",
           "difference of the pattern's area from that of the known panels, over the latter", kLow,
           {1e-3, 0.05}, &M::pattern_area)
      .row("panel_area_error", "1", "the same of the panel that is farthest off", kLow,
           {1e-3, 0.05}, &M::panel_area);
}

MetricGroup area_group() {
  return frame_metrics<SketchScene>(surface_area_error)
      .row("surface_area_error", "1",
           "difference of the surface's area from that of the known thing, over the latter", kLow,
           {1e-3, 0.05}, [](const std::optional<double>& error) { return error; });
}

MetricGroup arc_group() {
  using M = ArcMeasures;
  return frame_metrics<SketchScene>(arc_measures)
      .row("arc_rms", "%",
           "root mean square distance, in the view, of the points of drawn arcs from the arcs of "
           "the reconstruction, over the picture's width",
           kLow, {1e-4, 0.02}, &M::rms_percent)
      .row("arc_max", "%", "the largest such distance", kLow, {1e-4, 0.02}, &M::max_percent)
      .row("arc_off_surface", "%",
           "largest distance of the arcs of the reconstruction from its surface", kLow,
           {1e-3, 0.05}, &M::off_surface_percent)
      .row("radius_error", "1", "relative error of a circle's radius, of a known shape; the worst",
           kLow, {1e-4, 0.02}, &M::radius_error)
      .row("axis_error", "deg", "angle between a circle's axis and the true one; the worst", kLow,
           {1e-3, 0.02}, &M::axis_error_deg);
}

MetricGroup layer_group() {
  using M = LayerMeasures;
  return frame_metrics<SketchScene>(layer_measures)
      .row("layer_pairs", "1",
           "pairs of triangles of different layers that intersect, layers taken "
           "with their thickness",
           kLow, kCount, &M::pairs)
      .row("layer_depth", "%", "how deep they do, over the picture's width", kLow, {1e-3, 0.05},
           &M::depth_percent)
      .row(
          "uncovered", "1",
          "share of a layer's rear rim below which there is no layer, without a tenth at each end; "
          "the worst",
          kLow, kShare, &M::uncovered)
      .row("rivets_off", "%", "largest distance of a rivet from its own layer", kLow, {1e-3, 0.05},
           &M::rivets_off_percent)
      .row("rivets_apart", "%",
           "largest distance of a layer's rivets from the line through those of its neighbour",
           kLow, {1e-6, 0.05}, &M::rivets_apart_percent)
      .row("asymmetry", "%", "at rest, Hausdorff distance of the surface from its mirror image",
           kLow, {1e-3, 0.05}, &M::asymmetry_percent);
}

MetricGroup edge_group() {
  using M = EdgeMeasures;
  return frame_metrics<SketchScene>(edge_measures)
      .row("edge_off", "1",
           "at rest, largest distance in the view of a point of a drawn edge from that edge of the "
           "layers, over the edge's radius; the worst edge",
           kLow, {1e-5, 0.02}, &M::drawn)
      .row("edge_off_known", "1",
           "the same in space, of a known shape: of the edge's true points, without the hand's "
           "noise",
           kLow, {1e-5, 0.02}, &M::known);
}

MetricGroup texture_group() {
  return frame_metrics<SketchScene>(background_texels)
      .row("background_texels", "1",
           "share of the texels within 2 of a piece's border that have the colour of the "
           "photograph's background, where that is known",
           kLow, kShare, [](const std::optional<double>& share) { return share; });
}

MetricGroup sector_group() {
  return frame_metrics<SketchScene>(sector_length_error)
      .row("sector_error", "1",
           "largest relative difference between an edge of a layer's flat piece and the same edge "
           "in "
           "space, both as circular arcs",
           kLow, {1e-9, 0}, [](const std::optional<double>& error) { return error; })
      .oracle();
}

}  // namespace

std::vector<MetricGroup> metrics() {
  std::vector<MetricGroup> groups{surface_group(), silhouette_group(), pattern_group(),
                                  truth_group(),   cut_group(),        arc_group(),
                                  layer_group(),   sector_group(),     edge_group(),
                                  texture_group(), area_group()};
  for (MetricGroup& group : garment_metrics()) groups.push_back(std::move(group));
  for (MetricGroup& group : seam_metrics()) groups.push_back(std::move(group));
  return groups;
}

}  // namespace geoprior::sketch
