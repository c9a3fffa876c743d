#include "experiments/assembly/measures.h"
#include "experiments/assembly/topic.h"
#include "testbed/metric_rows.h"

namespace geoprior::assembly {
namespace {

// Runs of one build are equal bit for bit; tolerances are for other compilers and processors.
constexpr Tolerance kSmooth{1e-9, 1e-6};
constexpr Tolerance kExact{0, 0};
constexpr Direction kLow = Direction::lower_is_better;
constexpr Direction kHigh = Direction::higher_is_better;
constexpr Direction kNone = Direction::none;

MetricGroup joint_group() {
  using M = JointMeasures;
  return frame_metrics<AssemblyScene>(joint_measures)
      .row("closure_gap", "m", "largest distance of two joined ports", kLow, kSmooth, &M::gap)
      .row("closure_angle", "deg", "largest angle between two joined ports", kLow, kSmooth,
           &M::angle)
      .row("loose_joints", "1",
           "joints that are further apart, or turned further, than the worst joint of the inputs",
           kLow, kExact, [](const M& m) { return m.over_input; })
      .row("unseen_joints", "1",
           "joints of ports that no input joins, up to symmetries of the parts: 0 where every new "
           "joint was checked",
           kLow, kExact, [](const M& m) { return m.unseen; })
      .oracle();
}

MetricGroup stand_group() {
  using M = StandMeasures;
  return frame_metrics<AssemblyScene>(stand_measures)
      .row("ground_gap", "m",
           "largest distance from the floor of the lowest point of a part that is to stand on it",
           kLow, kSmooth, &M::ground_gap)
      .row("way_rise", "m",
           "most that a ball's way, from an entry to where it ends, rises above a point before",
           kLow, kSmooth, &M::rise)
      .row("lost_ways", "1", "balls' ways that do not end in an exit", kLow, kExact, &M::lost_ways)
      .row("entries", "1", "parts of the labels of entries", kNone, kExact, &M::entries)
      .row("exits", "1", "parts of the labels of exits", kNone, kExact, &M::exits);
}

MetricGroup meeting_group() {
  return frame_metrics<AssemblyScene>(meeting_parts)
      .row("meeting_parts", "1",
           "pairs of parts that are not joined and of which two triangles intersect", kLow, kExact);
}

MetricGroup variety_group() {
  using M = VarietyMeasures;
  return frame_metrics<AssemblyScene>(variety_measures)
      .row("label_distance", "1",
           "half the sum of the differences of the shares of labels to those of the nearest input: "
           "0 for the same shares, 1 for none in common",
           kHigh, kSmooth, [](const M& m) { return m.labels; })
      .row("spectral_distance", "1",
           "mean difference of the eigenvalues of the graph's normalised Laplacian, rank by rank, "
           "to those of the nearest input",
           kHigh, kSmooth, [](const M& m) { return m.spectrum; })
      .row("exchanged_share", "1", "share of the parts that were copied from a donor", kNone,
           kSmooth, [](const M& m) { return m.exchanged; })
      .row("parts", "1", "parts of the variation", kNone, kExact,
           [](const M& m) { return m.parts; });
}

MetricGroup run_group() {
  using M = RunMeasures;
  return sequence_metrics<AssemblyScene>(run_measures)
      .row("variations", "1", "variations of the run", kHigh, kExact,
           [](const M& m) { return m.variations; })
      .row("distinct_variations", "1",
           "of these, those of which no two, and none and an input, are isomorphic as graphs of "
           "labelled parts and ports",
           kHigh, kExact, [](const M& m) { return m.distinct; })
      .row("label_spread", "1", "mean distance of the shares of labels of two variations", kHigh,
           kSmooth, [](const M& m) { return m.spread; });
}

MetricGroup target_group() {
  using M = TargetMeasures;
  return frame_metrics<AssemblyScene>(target_measures)
      .row("target_distance", "m",
           "mean distance in plan of the ways to the outline and of the outline to the ways, half "
           "of their sum",
           kLow, kSmooth, &M::distance)
      .row("target_fill", "1",
           "share of the region's points, on a square lattice, that are within a spacing of a way "
           "in plan",
           kHigh, kSmooth, &M::fill);
}

MetricGroup best_group() {
  using M = BestMeasures;
  return sequence_metrics<AssemblyScene>(best_measures)
      .row("best_distance", "m", "smallest target_distance of a frame of the run", kLow, kSmooth,
           &M::distance)
      .row("best_fill", "1", "largest target_fill of a frame of the run", kHigh, kSmooth, &M::fill);
}

MetricGroup survey_group() {
  using M = SurveyMeasures;
  return frame_metrics<AssemblyScene>(survey_measures)
      .row("boundaries_1", "1",
           "boundaries of one connection, of the substructures that are listed", kNone, kExact,
           [](const M& m) { return m.boundaries[0]; })
      .row("boundaries_2", "1", "boundaries of two connections", kNone, kExact,
           [](const M& m) { return m.boundaries[1]; })
      .row("boundaries_3", "1", "boundaries of three connections", kNone, kExact,
           [](const M& m) { return m.boundaries[2]; })
      .row("boundaries_4", "1", "boundaries of four connections", kNone, kExact,
           [](const M& m) { return m.boundaries[3]; })
      .row("substructures", "1", "substructures that are listed", kNone, kExact,
           [](const M& m) { return m.substructures; })
      .row("union_substructures", "1",
           "of these, those that leave more pieces of the model than there were: their boundaries "
           "are unions of bonds",
           kNone, kExact, [](const M& m) { return m.unions; })
      .row("replacements", "1",
           "consistent replacements: a substructure, one for it, and a match of their boundaries",
           kNone, kExact, &M::pairs)
      .row("outputs", "1", "distinct assemblies of consistent replacements", kNone, kExact,
           [](const M& m) { return m.outputs; })
      .row("held_replacements", "1",
           "replacements that change something and of which one piece of the model holds several "
           "seams",
           kNone, kExact, [](const M& m) { return m.residuals; })
      .row("residual_median", "m",
           "median over these of the largest gap at a seam, before any filter, to a tenth of a "
           "decade",
           kNone, kSmooth, &M::residual_median)
      .row("closing_share", "1", "share of these within the scene's tolerance", kNone, kSmooth,
           &M::closing_share);
}

MetricGroup coverage_group() {
  using M = CoverageMeasures;
  return reference_metrics<AssemblyScene>({"substructures", "outputs"}, coverage_measures)
      .row("covered_substructures", "1",
           "share of the reference variant's substructures that are listed", kHigh, kSmooth,
           &M::substructures)
      .row("covered_replacements", "1",
           "share of the reference variant's replacements that are made", kHigh, kSmooth, &M::pairs)
      .row("covered_outputs", "1",
           "share of the reference variant's distinct assemblies that are made", kHigh, kSmooth,
           &M::outputs)
      .row("false_substructures", "1", "substructures that the reference variant does not list",
           kLow, kExact, [](const M& m) { return m.false_substructures; })
      .row("false_replacements", "1", "replacements that the reference variant does not make", kLow,
           kExact, [](const M& m) { return m.false_pairs; })
      .row("false_outputs", "1", "distinct assemblies that the reference variant does not make",
           kLow, kExact, [](const M& m) { return m.false_outputs; })
      .row("substructure_errors", "1",
           "substructures of the reference variant that are not listed, and rows of the list that "
           "are none of its substructures, or one that is listed already: 0 for the same set",
           kLow, kExact, [](const M& m) { return m.substructure_errors; });
}

}  // namespace

std::vector<MetricGroup> metrics() {
  return {joint_group(),  stand_group(), meeting_group(), variety_group(), run_group(),
          target_group(), best_group(),  survey_group(),  coverage_group()};
}

}  // namespace geoprior::assembly
