#include "experiments/grammar/measures.h"
#include "experiments/grammar/topic.h"
#include "testbed/metric_rows.h"

namespace geoprior::grammar {
namespace {

// Runs of one build are equal bit for bit; tolerances are for other compilers and processors.
constexpr Tolerance kSmooth{1e-9, 1e-6};
constexpr Tolerance kExact{0, 0};
constexpr Direction kLow = Direction::lower_is_better;
constexpr Direction kNone = Direction::none;

using ConstraintRows = MetricRows<ConstraintMeasures>;

void add_building_rows(ConstraintRows& rows) {
  using M = ConstraintMeasures;
  rows.row(
          "wall_angle_deg", "deg",
          "largest deviation from 90 of the angle of two adjacent walls of a storey, at the bottom "
          "and at the top, or of a wall's end from the vertical",
          kLow, kSmooth, [](const M& m) { return m.building.wall_angle.worst; })
      .row("wall_gap", "m",
           "largest distance of a wall's corner from that of the wall that it meets, and from its "
           "storey's",
           kLow, kSmooth, [](const M& m) { return m.building.wall_gap.worst; })
      .row("storey_height_violation", "m",
           "most that the height of a storey, at any of its corners, is out of 2.6 to 4.5 m", kLow,
           kSmooth, [](const M& m) { return m.building.storey_height.worst; })
      .row("storey_gap", "m",
           "largest difference in height of a bottom corner of a storey, or of an eave, from the "
           "top of the storey below, of the lowest from the ground",
           kLow, kSmooth, [](const M& m) { return m.building.storey_gap.worst; })
      .row("overhang_violation", "m",
           "most by which the distance in plan of the middle of a storey's side at its bottom from "
           "that of the storey below at its top exceeds 0.6 m",
           kLow, kSmooth, [](const M& m) { return m.building.overhang.worst; })
      .row("window_pitch_violation", "m",
           "most that the distance along a wall of the centres of neighbouring windows, a door "
           "being one, is out of 1.2 to 2.4 m",
           kLow, kSmooth, [](const M& m) { return m.building.window_pitch.worst; })
      .row("window_outside", "m",
           "most that a corner of a window or door is out of its wall's rectangle, in its plane or "
           "across",
           kLow, kSmooth, [](const M& m) { return m.building.window_outside.worst; })
      .row("door_gap", "m",
           "largest difference in height of a door's lowest corner from the bottom of the lowest "
           "storey",
           kLow, kSmooth, [](const M& m) { return m.building.door_gap.worst; });
}

void add_tree_rows(ConstraintRows& rows) {
  using M = ConstraintMeasures;
  rows.row("branch_length_violation", "m",
           "most that a branch's length is out of 0.5 to 1.5 of the mean of its level at rest",
           kLow, kSmooth, [](const M& m) { return m.tree.length.worst; })
      .row("attachment_gap", "m",
           "largest distance of a branch's base from the place on its parent's axis where it is "
           "attached",
           kLow, kSmooth, [](const M& m) { return m.tree.attachment.worst; })
      .row("crossings", "1",
           "pairs of branches whose capsules are in each other by over 1e-9 m, but for parent and "
           "child and those attached at one place of one branch",
           kLow, kExact, [](const M& m) { return m.tree.crossings.worst; });
}

void add_scatter_rows(ConstraintRows& rows) {
  using M = ConstraintMeasures;
  rows.row("spacing", "1",
           "smallest distance of two elements that are to keep apart over the sum of what they "
           "keep clear, size times radius: items, grains, conifers of a forest that has a spacing; "
           "pines and houses",
           kNone, kSmooth, [](const M& m) { return m.scatter.spacing; })
      .row("spacing_violation", "1", "1 less spacing; 0 where that is at least 1", kLow, kSmooth,
           [](const M& m) { return m.scatter.too_close.worst; })
      .row("ground_gap", "m",
           "largest height over or under the ground of the foot of a pine, conifer or house, or of "
           "a stone, or of a corner of a house's plinth over it",
           kLow, kSmooth, [](const M& m) { return m.scatter.ground_gap.worst; })
      .row("upright_deg", "deg",
           "largest angle of a pine, a conifer or the ridge or floor of a house from the vertical",
           kLow, kSmooth, [](const M& m) { return m.scatter.upright.worst; })
      .row("path_pitch_violation", "m",
           "most that the distance of consecutive stones of a path is out of 0.6 to 1.4 of its "
           "pitch",
           kLow, kSmooth, [](const M& m) { return m.scatter.path_pitch.worst; });
}

void add_machine_rows(ConstraintRows& rows) {
  using M = ConstraintMeasures;
  rows.row("part_shape", "m",
           "imported engine: largest distance of a corner of a part from where a right-angled box "
           "has it, and change of an edge of all but the body",
           kLow, kSmooth, [](const M& m) { return m.machine.shape.worst; })
      .row("part_turn_deg", "deg",
           "imported engine: largest angle of an edge of body, pistons and lifters to what it was "
           "at rest",
           kLow, kSmooth, [](const M& m) { return m.machine.turn.worst; })
      .row("part_slide", "m",
           "imported engine: largest shift of a piston or lifter across its axis, of a rod out of "
           "its plane",
           kLow, kSmooth, [](const M& m) { return m.machine.slide.worst; })
      .row("link_distance", "m",
           "imported engine: largest change of the distance of two neighbouring links of a spring",
           kLow, kSmooth, [](const M& m) { return m.machine.links.worst; });
}

MetricGroup constraint_group() {
  ConstraintRows rows = frame_metrics<GrammarScene>(constraint_measures);
  rows.row("violations", "1",
           "constraints of the object that are broken by over 1e-9 of their unit, each wall, "
           "branch, window and pair counted",
           kLow, kExact, [](const ConstraintMeasures& m) { return m.broken(); });
  add_building_rows(rows);
  add_tree_rows(rows);
  add_scatter_rows(rows);
  add_machine_rows(rows);
  return rows;
}

MetricGroup fidelity_group() {
  using M = FidelityMeasures;
  return frame_metrics<GrammarScene>(fidelity_measures)
      .row("deviation", "m",
           "distance of the key points from where the user's edits and map take those of the rest: "
           "root mean square over the elements of that over their key points, of those that there "
           "were and are",
           kLow, kSmooth, [](const M& m) { return m.deviation; })
      .row("deviation_of_nothing", "m",
           "the same of the same elements, if the object had stayed as it is at rest", kNone,
           kSmooth, [](const M& m) { return m.of_nothing; })
      .row("deviation_ratio", "1", "deviation over deviation_of_nothing, where that is not 0", kLow,
           kSmooth, [](const M& m) { return m.ratio; });
}

MetricGroup change_group() {
  using M = ChangeMeasures;
  return frame_metrics<GrammarScene>(change_measures)
      .row("touched_share", "1",
           "share of the elements at rest that are gone, or of which a key point or a parameter is "
           "not the same, bit for bit",
           kNone, kSmooth, [](const M& m) { return m.touched_share; })
      .row("lost_elements", "1", "elements at rest that are gone", kNone, kExact,
           [](const M& m) { return m.lost; })
      .row("new_elements", "1", "elements that there were not at rest", kNone, kExact,
           [](const M& m) { return m.added; })
      .row("kept_size", "1",
           "mean over the elements that have a size at rest of what is left of it, 0 of those that "
           "are gone: 1 where nobody shrank to keep apart",
           Direction::higher_is_better, kSmooth, &M::kept_size);
}

MetricGroup distribution_group() {
  using M = DistributionMeasures;
  return frame_metrics<GrammarScene>(distribution_measures)
      .row("ks_branch_length", "1",
           "Kolmogorov-Smirnov distance from rest of the lengths of branches, each over the mean "
           "of its level at rest",
           kLow, kSmooth, &M::branch_lengths)
      .row("ks_branch_angle", "1",
           "Kolmogorov-Smirnov distance from rest of the angles of branches to the branch that "
           "they are attached to",
           kLow, kSmooth, &M::branch_angles)
      .row("spread_of_spacing", "1",
           "standard deviation over mean of the distance of a set's elements from the nearest "
           "other, of those of at least half their size",
           kLow, kSmooth, &M::spread)
      .row("hole", "1",
           "largest distance of a place of a set's object from the nearest of these elements, over "
           "the spacing: places are the vertices of a surface, and in a volume the middles of any "
           "two elements at rest within 1.5 spacings, where the map takes them",
           kLow, kSmooth, &M::hole);
}

MetricGroup reference_group() {
  using M = ReferenceMeasures;
  return reference_metrics<GrammarScene>({"elements", "keys"}, reference_measures)
      .row("deviation_over_reference", "1",
           "deviation over that of the reference variant, where that is not 0", kLow, kSmooth,
           &M::deviation_ratio)
      .row("difference_from_reference", "m",
           "largest distance of a key point from the same of the reference variant, by the numbers "
           "of element and key point",
           kLow, kSmooth, &M::difference)
      .row("unmatched_with_reference", "1",
           "elements that only one of the variant and the reference variant has", kLow, kExact,
           [](const M& m) { return m.unmatched; });
}

MetricGroup motion_group() {
  using M = MotionMeasures;
  return sequence_metrics<GrammarScene>(motion_measures)
      .row("pop", "m",
           "largest displacement of a key point from one step of a gesture to the next that the "
           "change of the user's map does not explain: its distance from the nearest of those "
           "between staying and following",
           kLow, kSmooth, &M::pop)
      .row("pop_ratio", "1",
           "the same, each over the size of its element, the largest extent that it has in the "
           "gesture, at full size where it has a size; one that comes or goes moves by its extent",
           kLow, kSmooth, &M::pop_ratio)
      .row("return_gap", "m",
           "largest distance of a key point from where it was when the gesture began, at any step "
           "at which the gesture is back there; an element that comes or goes counts with its "
           "extent",
           kLow, kSmooth, &M::return_gap)
      .oracle();
}

MetricGroup locality_group() {
  using M = LocalityMeasures;
  return sequence_metrics<GrammarScene>(locality_measures)
      .row("stray_changes", "1",
           "elements that are not the same bytes as before a gesture, though the boxes of their "
           "key points, and of those of the elements above them below the root, are a tenth of "
           "the object's diagonal or more from where the map of this or an earlier step of the "
           "gesture is not the identity; at the worst step",
           kLow, kExact, &M::stray_of_gestures)
      .row("tagged_change", "m",
           "largest change of a distance between two key points of a tagged element since its "
           "edit, at any later frame",
           kLow, kSmooth, &M::tagged_change)
      .row("tagged_parameter_change", "1",
           "largest difference of a parameter of a tagged element, in the parameter's unit, since "
           "its edit, at any later frame",
           kLow, kExact, &M::tagged_parameter_change)
      .row("lost_edits", "1",
           "tagged elements that at some later frame are gone, or of which a distance between key "
           "points changed by over 1e-9 m or a parameter at all",
           kLow, kExact, &M::lost_edits);
}

MetricGroup suite_group() {
  using M = SuiteMeasures;
  return sequence_metrics<GrammarScene>(suite_measures)
      .row("gestures", "1", "steps of a gesture, or random gestures", kNone, kExact,
           [](const M& m) { return m.gestures; })
      .row("broken_gestures", "1", "of these, those with violations", kLow, kExact,
           &M::broken_gestures)
      .row("worst_violations", "1", "most violations of one of them", kLow, kExact,
           &M::worst_violations)
      .row("mean_deviation_ratio", "1",
           "mean over them of deviation over that of deviation_of_nothing", kLow, kSmooth,
           &M::mean_deviation_ratio)
      .row("worst_deviation_ratio", "1", "largest deviation_ratio of one of them", kLow, kSmooth,
           &M::worst_deviation_ratio)
      .row("unserved_ratio", "1",
           "as mean_deviation_ratio, of all elements that there were, where one that is gone or "
           "breaks a constraint of its own counts as if it had stayed at rest, or as it is where "
           "that is farther: 1 of doing nothing, and of what breaks everything",
           kLow, kSmooth, &M::unserved_ratio);
}

}  // namespace

std::vector<MetricGroup> metrics() {
  return {constraint_group(), fidelity_group(), change_group(),   distribution_group(),
          reference_group(),  motion_group(),   locality_group(), suite_group()};
}

}  // namespace geoprior::grammar
