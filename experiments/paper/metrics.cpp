#include <memory>
#include <vector>

#include "experiments/paper/measures.h"
#include "experiments/paper/tear_measures.h"
#include "experiments/paper/topic.h"
#include "testbed/metric_rows.h"

namespace geoprior::paper {
namespace {

// Runs of one build are equal bit for bit; tolerances are for other compilers and processors.
// Smooth quantities follow the solver's round-off; a count changes when something crosses its
// threshold; singular values of an isometry have the root of round-off.
constexpr Tolerance kSmooth{1e-12, 1e-6};
constexpr Tolerance kStrain{1e-7, 1e-6};
constexpr Tolerance kCount{1, 0.02};
constexpr Tolerance kShare{0.01, 0};

constexpr Direction kLow = Direction::lower_is_better;
constexpr Direction kHigh = Direction::higher_is_better;
constexpr Direction kTarget = Direction::closer_to_target;
constexpr Direction kNone = Direction::none;

/// A group of metrics of a frame of a sheet.
template <class Measure>
auto of_frame(Measure measure) {
  using Measures = metric_rows_detail::MeasuresOf<Measure, const SheetFrame&>;
  return frame_metrics<PaperScene>(
      [measure](const PaperScene& scene, const Frame& frame) -> std::optional<Measures> {
        return measure(sheet_frame(scene, frame));
      });
}

MetricGroup isometry_group() {
  using M = IsometrySummary;
  return of_frame(sheet_isometry)
      .row("isometry_rms", "1",
           "root mean square, by pattern area, of |sigma - 1|, sigma the two singular values of "
           "each triangle's map from the pattern to space",
           kLow, kStrain, &M::rms)
      .row("isometry_max", "1", "largest |sigma - 1| of a triangle", kLow, kStrain, &M::max)
      .row("edge_length_error", "1",
           "relative change of length against the pattern that 95 % of the edges, by their "
           "length, stay under",
           kLow, kStrain, &M::edge_error_p95)
      .row("edge_length_error_max", "1",
           "largest relative change of an edge's length against the pattern", kLow, kStrain,
           &M::edge_error_max)
      .row("area_drift", "1", "area in space over the area of the pattern's triangles, minus 1",
           kTarget, kStrain, &M::area_drift);
}

MetricGroup developability_group() {
  using M = DevelopabilitySummary;
  return of_frame(sheet_developability)
      .row("angle_defect_mean", "rad", "mean of |angle defect| over the interior vertices", kLow,
           kSmooth, &M::angle_defect_mean)
      .row("angle_defect_max", "rad", "largest |angle defect| of an interior vertex", kLow, kSmooth,
           &M::angle_defect_max)
      .row("hinge_energy_sum", "rad",
           "sum over the interior vertices of the smallest eigenvalue of sum theta n n' over the "
           "star (Stein, Grinspun, Crane 2018)",
           kLow, kSmooth, &M::hinge_energy_sum)
      .row("hinge_energy_max", "rad", "largest such eigenvalue", kLow, kSmooth,
           &M::hinge_energy_max)
      .row("gauss_image_thinness", "1",
           "share of the area at interior vertices whose triangles' normals lie within one degree "
           "of a great circle",
           kHigh, kShare, &M::thinness);
}

MetricGroup crease_group(const std::shared_ptr<ConeMemo>& memo) {
  using M = CreaseMeasures;
  return of_frame([memo](const SheetFrame& f) { return crease_measures(*memo, f); })
      .row("crease_length", "m",
           "length in the pattern of the folds where the normal turns by more than 20 degrees "
           "within about 5 mm, by crossings of the links of a 2.5 mm grid (Cauchy, Crofton)",
           kNone, {5e-3, 0.02}, &M::crease_length)
      .row("dcone_count", "1",
           "singular points: peaks above 0.05 rad, 20 mm apart, of the hinge energy of a ring of "
           "10 mm radius about the points of a 5 mm grid",
           kNone, kCount, &M::cones)
      .row("facet_count", "1",
           "facets of at least 1 cm^2 between creases: connected points of a 2.5 mm grid whose "
           "neighbours' normals differ by at most 20 degrees",
           kNone, kCount, &M::facets)
      .row("facet_area_median", "m^2",
           "median area of those facets, weighted by area: half of the sheet lies in facets no "
           "larger",
           kNone, {1e-4, 0.02}, &M::facet_area_median);
}

MetricGroup energy_group() {
  using M = EnergyMeasures;
  const auto fits = std::make_shared<FitMemo>();
  return of_frame([fits](const SheetFrame& f) { return energy_measures(*fits, f); })
      .row("membrane_energy", "J",
           "elastic energy of stretching of the mesh, St. Venant-Kirchhoff, with the scene's "
           "material",
           kNone, kSmooth, &M::membrane)
      .row("bending_energy", "J",
           "elastic energy of bending of the mesh, from the shape operators that the dihedral "
           "angles give, minus the plastic curvature, with the scene's material unweakened",
           kNone, kSmooth, &M::bending)
      .row("kinetic_energy", "J", "kinetic energy of the velocities, linear on each triangle",
           kNone, kSmooth, &M::kinetic);
}

MetricGroup fold_group() {
  using M = FoldMeasures;
  const auto fits = std::make_shared<FitMemo>();
  return of_frame([fits](const SheetFrame& f) { return fold_measures(*fits, f); })
      .row("cancelling_share", "1",
           "share of the folds that opposite ones within discs of the pattern cancel, by length "
           "times angle; a fold is positive when it has the sign that it has on a cylinder bent in "
           "the sheet's main direction there",
           kLow, kShare, &M::cancelling_share)
      .row("fold_energy", "J",
           "elastic energy of bending with every fold counted for itself, minus the plastic "
           "curvature, scaled to the plate's on cylinders",
           kNone, kSmooth, &M::energy);
}

MetricGroup motion_group() {
  using M = MotionMeasures;
  const auto fits = std::make_shared<FitMemo>();
  return sequence_metrics<PaperScene>(
             [fits](const PaperScene& scene, const FrameSequence& frames) -> std::optional<M> {
               return motion_measures(*fits, scene, frames);
             })
      .row("second_difference_p95", "m",
           "second difference in time of a point of the sheet, a frame apart, that 95 % of the "
           "points of a grid of the pattern over all frames stay under",
           kLow, kSmooth, &M::second_difference_p95)
      .row("energy_spike", "1",
           "largest elastic energy of a frame over the greater one of its two neighbours, among "
           "the frames with a tenth of the run's largest or more",
           kLow, kShare, &M::energy_spike);
}

MetricGroup quadric_bending_group() {
  const auto quadrics = std::make_shared<QuadricMemo>();
  return of_frame([quadrics](const SheetFrame& f) { return quadric_bending_energy(*quadrics, f); })
      .row("bending_energy_quadric", "J",
           "bending_energy by quadrics fitted to the places about each triangle, without dihedral "
           "angles: apart from the element that solvers minimise; only for a rectangle bent by two "
           "opposite sides alone, because creases and fans about an apex escape it",
           kNone, kSmooth);
}

MetricGroup handle_work_group() {
  return of_frame(handle_work)
      .row("handle_work", "J",
           "work done on the sheet by the prescribed handles since the start, summed "
           "over the steps by the method",
           kNone, kSmooth);
}

MetricGroup handle_force_group() {
  using M = HandleForce;
  return of_frame(handle_force)
      .row("handle_force_max", "N",
           "largest norm of the total force of a handle on the sheet, mean over the "
           "steps of the frame",
           kNone, kSmooth, &M::max)
      .row("handle_force_mean", "N",
           "mean over the handles of the norm of the total force on the sheet, mean "
           "over the steps of the frame",
           kNone, kSmooth, &M::mean);
}

/// Oracles: whatever a method does, its mesh covers the pattern once.
MetricGroup mesh_group() {
  using M = const MeshMeasures&;
  return of_frame(mesh_measures)
      .row("triangles", "1", "triangles of the surface's mesh", kLow, kCount,
           [](M m) { return static_cast<double>(m.triangles); })
      .row("min_altitude", "m",
           "smallest height of a triangle of the pattern over its longest edge; negative for one "
           "turned over",
           kHigh, kSmooth, [](M m) { return m.pattern.min_altitude; })
      .row("min_area", "m^2", "smallest signed area of a triangle of the pattern", kHigh, kSmooth,
           [](M m) { return m.pattern.min_area; })
      .row("inverted_triangles", "1",
           "triangles that are turned over in the pattern or have no area there", kLow, kCount,
           [](M m) { return m.pattern.inverted; })
      .oracle()
      .row("uncovered_area", "m^2",
           "absolute difference of the pattern's area and the sum of its triangles' signed areas",
           kLow, kSmooth, [](M m) { return m.uncovered_area; })
      .oracle();
}

MetricGroup contact_group() {
  using M = ContactMeasures;
  return of_frame(contact_measures)
      .row("intersecting_pairs", "1", "pairs of triangles that intersect each other", kLow, kCount,
           &M::intersecting_pairs)
      .row("intersection_depth", "m",
           "largest, over the intersecting pairs, of the shortest way along a normal of the two "
           "that takes them apart; at most the triangles' height",
           kLow, {1e-9, 1e-6}, &M::intersection_depth);
}

MetricGroup elastica_group() {
  return of_frame(elastica_error)
      .row("elastica_error", "1",
           "height of the middle of a strip pinned at two opposite sides against "
           "Euler's elastica of the same distance of the ends, relative; absent until "
           "the strip is shortened by a thousandth",
           kLow, {1e-7, 1e-6})
      .oracle();
}

/// No oracle: the closed form is that of small slopes and no thickness, which no sheet has.
MetricGroup sector_group() {
  return of_frame(ring_sector)
      .row("dcone_sector", "deg",
           "sector over which a sheet pushed into a ring (the scene's torus) leaves it: 1.653 "
           "times the width at a fifth of the rise, on the ring's circle in the pattern; absent "
           "before the rise is half of the apex' depth and when there are several sectors",
           kTarget, {0.5, 0})
      .target(138.99);
}

MetricGroup distance_group() {
  return reference_metrics<PaperScene>({"surface"},
                                       [](const PaperScene& scene, const Frame& frame,
                                          const Frame& reference) -> std::optional<double> {
                                         return hausdorff_ratio(sheet_frame(scene, frame),
                                                                sheet_frame(scene, reference));
                                       })
      .row("hausdorff_ratio", "1",
           "Hausdorff distance from the surface of the reference variant, sampled every 32nd of "
           "the pattern's width, over that width",
           kLow, {1e-7, 1e-6});
}

MetricGroup cone_distance_group(const std::shared_ptr<ConeMemo>& memo) {
  return reference_metrics<PaperScene>({"surface"},
                                       [memo](const PaperScene& scene, const Frame& frame,
                                              const Frame& reference) -> std::optional<double> {
                                         return dcone_distance(*memo, sheet_frame(scene, frame),
                                                               sheet_frame(scene, reference));
                                       })
      .row("dcone_distance", "m",
           "largest distance in the pattern of a singular point that the detector finds on the "
           "reference variant's surface from the nearest that it finds here; the diagonal of the "
           "pattern's bounding box when it finds none here, absent when it finds none there",
           kLow, {5e-3, 0.02});
}

MetricGroup tear_group() {
  using M = const TearMeasures&;
  return of_frame(tear_measures)
      .row("tear_length", "m",
           "length by which the tears have grown, in the pattern: that of either lip", kNone,
           kSmooth, [](M m) { return m.length; })
      .row("parts", "1", "parts that the sheet has fallen into", kNone, kCount,
           [](M m) { return static_cast<double>(m.parts); })
      .row("tear_drift", "1",
           "how far the difference of the distances from the tip of the longest tear to two hands "
           "A and B goes from what it was at the start, over |AB|, in the pattern: 0 on the "
           "hyperbola that a taut inextensible sheet tears along; absent unless two hands move",
           kLow, kSmooth, [](M m) { return m.drift; })
      .row("tear_deviation", "deg",
           "angle of the longest tear's chord to the bisector of two hands at its start", kLow,
           kSmooth, [](M m) { return m.deviation; })
      .row("tear_bow", "1",
           "farthest that a point of the longest tear lies from its chord, over the chord's length",
           kNone, kSmooth, [](M m) { return m.bow; })
      .row("fracture_energy", "J", "that the tears took: E_f over the torn section", kNone, kSmooth,
           [](M m) { return m.energy; });
}

MetricGroup energy_gap_group() {
  const auto fits = std::make_shared<FitMemo>();
  return of_frame([fits](const SheetFrame& f) { return energy_gap(*fits, f); })
      .row("energy_gap", "1",
           "what is left of the hands' work, relative to it, once elastic and kinetic energy, that "
           "of hands that give and fracture_energy are taken away: what time stepping damps; below "
           "0 the tears took more than there was; absent before a tear has grown",
           kTarget, kShare);
}

MetricGroup tearing_force_group() {
  using M = TearingForces;
  return sequence_metrics<PaperScene>(tearing_forces)
      .row("onset_force", "1",
           "largest handle force over K e / (2 cos(theta / 2)), at which a taut inextensible sheet "
           "tears between two hands, in the last frame before a tear has grown",
           kTarget, kShare, &M::onset)
      .target(1)
      .row("tearing_force", "N",
           "mean over the handles of the norm of the total force, median of the frames in which a "
           "tear has grown",
           kNone, kSmooth, &M::growing);
}

MetricGroup tear_path_group() {
  using M = const PathComparison&;
  return reference_metrics<PaperScene>(
             {"surface", "tears"},
             [](const PaperScene& scene, const Frame& frame, const Frame& reference) {
               return tear_beside_reference(sheet_frame(scene, frame),
                                            sheet_frame(scene, reference));
             })
      .row("tear_path_distance", "m",
           "Hausdorff distance of the longest tear from that of the reference variant, in the "
           "pattern, as far as the shorter of both goes",
           kLow, kSmooth, [](M m) { return m.distance; })
      .row("tear_path_drift", "1",
           "farthest that a point of the longest tear lies from that of the reference variant, in "
           "the pattern, over the length that the shorter of both has: a drift where no closed "
           "form says where a tear goes",
           kLow, kSmooth, [](M m) { return m.drift; })
      .row("tear_path_deviation", "deg",
           "angle between the chords of the longest tear and of that of the reference variant, as "
           "far as the shorter of both goes",
           kLow, kSmooth, [](M m) { return m.deviation; });
}

}  // namespace

std::vector<MetricGroup> metrics() {
  const auto cones = std::make_shared<ConeMemo>();
  return {isometry_group(),
          developability_group(),
          crease_group(cones),
          energy_group(),
          fold_group(),
          motion_group(),
          quadric_bending_group(),
          handle_work_group(),
          handle_force_group(),
          mesh_group(),
          contact_group(),
          elastica_group(),
          sector_group(),
          distance_group(),
          cone_distance_group(cones),
          tear_group(),
          energy_gap_group(),
          tearing_force_group(),
          tear_path_group()};
}

}  // namespace geoprior::paper
