#include "experiments/embryo/measures.h"
#include "experiments/embryo/topic.h"
#include "testbed/metric_rows.h"

namespace geoprior::embryo {
namespace {

// Runs of one build are equal bit for bit; tolerances are for other compilers and processors.
constexpr Tolerance kSmooth{1e-9, 1e-6};
constexpr Tolerance kCount{0, 0};
constexpr Tolerance kMesh{50, 0.02};  // triangles, whose number follows the field's round-off
constexpr Direction kLow = Direction::lower_is_better;
constexpr Direction kNone = Direction::none;

MetricGroup ontology_group() {
  using M = OntologyMeasures;
  return frame_metrics<EmbryoScene>(ontology_measures)
      .row("violations", "1", "statements of the ontology that cannot be, of all kinds", kLow,
           kCount, [](const M& m) { return m.violations; })
      .oracle()
      .row("violations_of_sources", "1", "of these, numbers without unit or source", kLow, kCount,
           [](const M& m) { return m.sources; })
      .oracle()
      .row("violations_of_time", "1", "of these, of stages, intervals and orders in time", kLow,
           kCount, [](const M& m) { return m.time; })
      .oracle()
      .row("violations_of_geometry", "1", "of these, of geometrical components and key frames",
           kLow, kCount, [](const M& m) { return m.geometry; })
      .oracle()
      .row("violations_of_relations", "1", "of these, all others: classes, properties, relations",
           kLow, kCount, [](const M& m) { return m.relations; })
      .oracle();
}

MetricGroup surface_group() {
  using M = SurfaceMeasures;
  return frame_metrics<EmbryoScene>(surface_measures)
      .row("structures", "1", "structures with a surface", kNone, kCount,
           [](const M& m) { return m.structures; })
      .row("triangles", "1", "triangles of all surfaces", kNone, kMesh,
           [](const M& m) { return m.triangles; })
      .row("least_triangles", "1", "fewest triangles of a structure", Direction::higher_is_better,
           kMesh, [](const M& m) { return m.least_triangles; })
      .row("manifold_defects", "1",
           "edges and vertices at which a surface is no closed, oriented 2-manifold", kLow, kCount,
           [](const M& m) { return m.defects; })
      .oracle()
      .row("not_spheres", "1", "connected surfaces whose Euler number V - E + F is not 2", kLow,
           kCount, [](const M& m) { return m.not_spheres; })
      .oracle()
      .row("pieces", "1", "connected surfaces of all structures", kNone, kCount,
           [](const M& m) { return m.pieces; })
      .row("kidney_pieces", "1", "connected surfaces with triangles of a kidney", kNone, kCount,
           [](const M& m) { return m.kidney_pieces; })
      .oracle()
      .row("cloaca_pieces", "1",
           "connected surfaces with triangles of the cloaca or of what it divides into", kNone,
           kCount, [](const M& m) { return m.cloaca_pieces; })
      .oracle()
      .row("surface_error", "1",
           "largest distance of a vertex from its structure's recorded ovoid, cylinder or duct, "
           "over the smallest radius; of structures that nothing blends with or cuts",
           kLow, kSmooth, [](const M& m) { return m.surface_error; })
      .oracle()
      .row("undeclared_overlap", "m",
           "largest depth of a vertex of one surface in another, of structures between which the "
           "ontology declares no contact",
           kLow, kSmooth, [](const M& m) { return m.overlap; })
      .oracle()
      .row("seam_deg", "deg",
           "angle between the normals of two triangles of different structures at a common edge: "
           "root mean square over the length of these edges",
           kLow, Tolerance{0.5, 0.02}, [](const M& m) { return m.seam_deg; });
}

MetricGroup organ_group() {
  using M = OrganMeasures;
  return frame_metrics<EmbryoScene>(organ_measures)
      .row("crown_rump_length", "m", "length of the body from crown to rump", kNone, kSmooth,
           [](const M& m) { return m.crown_rump; })
      .row("kidney_length", "m", "extent of the left kidney's surface along its long axis", kNone,
           kSmooth, [](const M& m) { return m.kidney_length; })
      .row("hilum_angle", "rad",
           "angle of the left kidney's hilum from ventral towards the median plane", kNone, kSmooth,
           [](const M& m) { return m.hilum_angle; })
      .row("branchings", "1", "generations of branching of the left kidney's collecting system",
           kNone, kSmooth, [](const M& m) { return m.branchings; })
      .row("upper_pole_height", "m", "height of the left kidney's upper pole over the bifurcation",
           kNone, kSmooth, [](const M& m) { return m.upper_pole; })
      .row("lower_pole_height", "m", "height of the left kidney's lower pole over the bifurcation",
           kNone, kSmooth, [](const M& m) { return m.lower_pole; })
      .row("vertebral_level", "1",
           "level of the left kidney's centre: T12 is 12, L1 is 13, ... S1 is 18", kNone, kSmooth,
           [](const M& m) { return m.level; })
      .row("mirror_error", "1",
           "largest distance of a left structure's vertices, mirrored, from the right one's "
           "surface, over the crown-rump length; healthy only",
           kLow, kSmooth, [](const M& m) { return m.mirror; })
      .row(
          "duct_end_gap", "1",
          "largest distance of a duct's recorded end from its place on the recorded structure that "
          "it is anchored to, over the crown-rump length",
          kLow, kSmooth, [](const M& m) { return m.duct_end; });
}

MetricGroup change_group() {
  using M = ChangeMeasures;
  return sequence_metrics<EmbryoScene>(change_measures)
      .row("absent", "1", "structures that the reference shows some day, and this variant never",
           kNone, kCount, [](const M& m) { return m.absent; })
      .row("altered", "1",
           "other structures whose triangles or centre lines differ from the reference's in a bit "
           "some day",
           kNone, kCount, [](const M& m) { return m.altered; })
      .row("absent_errors", "1",
           "absent structures that are not expected, and expected that are not", kLow, kCount,
           [](const M& m) { return m.absent_errors; })
      .row("altered_errors", "1",
           "altered structures that are not expected, and expected that are not", kLow, kCount,
           [](const M& m) { return m.altered_errors; })
      .row("change_errors", "1",
           "absent_errors and altered_errors together: 0 where the list says each structure that "
           "changes, and how",
           kLow, kCount,
           [](const M& m) -> std::optional<double> {
             if (!m.absent_errors || !m.altered_errors) return {};
             return *m.absent_errors + *m.altered_errors;
           })
      .row("other_side_changes", "1",
           "structures of the side that a one-sided disease is not of that differ from the "
           "reference's in a bit some day",
           kLow, kCount, [](const M& m) { return m.other_side; })
      .oracle();
}

MetricGroup difference_group() {
  using M = DifferenceMeasures;
  return reference_metrics<EmbryoScene>({}, difference_measures)
      .row("state_difference", "1",
           "largest difference of the recorded centres, radii and axes from the reference's, over "
           "the crown-rump length",
           kLow, kSmooth, [](const M& m) { return m.state; })
      .row("surface_difference", "1",
           "largest distance of a vertex from the reference's surface of its structure, both ways, "
           "over the crown-rump length",
           kLow, kSmooth, [](const M& m) { return m.surface; })
      .row("unmatched_structures", "1",
           "structures of which only this variant, or only the reference, has a surface", kLow,
           kCount, [](const M& m) { return m.unmatched; });
}

MetricGroup motion_group() {
  using M = MotionMeasures;
  return sequence_metrics<EmbryoScene>(motion_measures)
      .row("velocity_jump", "1",
           "largest jump of the velocity of a structure's centre, radii or centre line at the "
           "middle of a stage, over its mean speed",
           kLow, Tolerance{1e-7, 1e-3}, [](const M& m) { return m.velocity_jump; })
      .row(
          "growth_reversals", "1",
          "structures that lose volume from one frame to the next, but for those that the ontology "
          "says to regress",
          kLow, kCount, [](const M& m) { return m.reversals; })
      .row("top_speed", "m/d", "largest speed of a structure's centre between two frames", kNone,
           kSmooth, [](const M& m) { return m.top_speed; });
}

MetricGroup score_group() {
  using M = ScoreMeasures;
  return sequence_metrics<EmbryoScene>(score_measures)
      .row("scored", "1", "measurements of the literature that the set was not authored from",
           kNone, kCount, [](const M& m) { return m.scored; })
      .row("scored_inside", "1", "of these, within the published range",
           Direction::higher_is_better, kCount, [](const M& m) { return m.inside; })
      .row("inputs", "1", "measurements that the set was authored from, and is not held against",
           kNone, kCount, [](const M& m) { return m.inputs; })
      .row("score_rms", "1",
           "root mean square, over the scored, of the distance from the mean over the deviation",
           kLow, kSmooth, [](const M& m) { return m.rms; })
      .row("score_worst", "1", "largest such distance", kLow, kSmooth,
           [](const M& m) { return m.worst; });
}

MetricGroup answer_rows_group() {
  return frame_metrics<EmbryoScene>(answer_rows)
      .row("answer_rows", "1", "rows of all queries of the viewer", kNone, kCount);
}

MetricGroup answer_group() {
  return reference_metrics<EmbryoScene>({}, answers_differing)
      .row("answers_differing", "1", "queries whose rows, as sets, are others than the reference's",
           kLow, kCount);
}

}  // namespace

std::vector<MetricGroup> metrics() {
  return {ontology_group(), surface_group(),     organ_group(),
          change_group(),   difference_group(),  motion_group(),
          score_group(),    answer_rows_group(), answer_group()};
}

}  // namespace geoprior::embryo
