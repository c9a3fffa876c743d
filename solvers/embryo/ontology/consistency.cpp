#include "solvers/embryo/ontology/consistency.h"

#include <algorithm>
#include <tuple>

#include "solvers/embryo/ontology/checks/findings.h"

namespace geoprior::embryo {

namespace {

constexpr ViolationKind kViolationKinds[] = {
    {"anchor_cycle", "Ducts are anchored on each other in a circle."},
    {"anchor_on_no_structure", "A duct is anchored on a thing that is no structure."},
    {"axis_parallel_to_up", "The two directions that turn a shape are parallel."},
    {"axis_zero", "A direction has no length."},
    {"child_before_progenitor", "A structure begins before what it develops from."},
    {"crown_rump_missing", "No structure has the crown-rump length."},
    {"crown_rump_not_line", "The structure that has the crown-rump length is no line."},
    {"crown_rump_twice", "Two structures have the crown-rump length."},
    {"develops_from_cycle", "Structures develop from each other in a circle."},
    {"disease_contradicts_itself", "A disease enables and disables one process."},
    {"disease_unknown_process", "A disease names a process that is not there."},
    {"disease_without_effect", "A disease disables and enables nothing."},
    {"division_positive_no_product", "The product on the side of the normal is not produced."},
    {"division_products", "A division has not exactly two products."},
    {"division_wholes", "A division divides more than one structure."},
    {"duct_with_two_ends", "An end of a duct is on a structure and free as well."},
    {"duct_without_end", "An end of a duct is nowhere."},
    {"egg_out_of_range", "An egg is more than half as wide at one pole as in its middle."},
    {"fixation_without_duct", "A fixation acts on what is no duct."},
    {"frame_cycle", "Structures are placed relative to each other in a circle."},
    {"fusion_of_one", "A fusion has one structure only."},
    {"hole_in_keys", "The keys of a structure leave more than a stage open at an end."},
    {"interval_reversed", "A structure ends before it begins."},
    {"key_outside_existence", "A key is at a stage at which its structure does not exist."},
    {"key_with_two_geometries", "A key has more than one geometry."},
    {"key_with_two_stages", "A key is at more than one stage."},
    {"key_with_two_structures", "A key is of more than one structure."},
    {"key_without_geometry", "A key has no geometry."},
    {"key_without_stage", "A key is at no stage."},
    {"key_without_structure", "A key is of no structure."},
    {"measurement_reversed", "The low of a measurement is above its high."},
    {"measurement_without_value", "A measurement has neither a range nor a mean."},
    {"mirror_on_one_side", "A structure and its mirror image are of one side."},
    {"misplaced_property", "A node has a property that its class has not."},
    {"missing_property", "A node lacks a property that its class requires."},
    {"missing_source", "A node with numbers has no source."},
    {"missing_unit", "A node with a length, an angle or a day has no unit of it."},
    {"negative_number", "A number is below zero that may not be."},
    {"no_class", "A node has properties of the vocabulary and no class."},
    {"not_finite", "A number is infinite or not a number."},
    {"not_positive", "A number is not above zero that must be."},
    {"part_of_cycle", "Structures are part of each other in a circle."},
    {"part_outside_whole", "A part exists when its whole does not."},
    {"placed_on_absent", "A geometry is placed on a structure that is not there at its stage."},
    {"primitive_changes", "The keys of a structure are of different primitives."},
    {"process_requires_cycle", "Processes require each other in a circle."},
    {"process_span_empty", "A process that takes time begins and ends at one stage."},
    {"process_span_reversed", "A process ends before it begins."},
    {"process_unknown_structure", "A process names a structure that is not there."},
    {"product_begins_elsewhere", "A product does not begin where its division ends."},
    {"product_with_keys", "A product of a division has keys of its own."},
    {"repeated_label", "Two structures have one label."},
    {"repeated_property", "A property has several values that may have one."},
    {"stage_next_against_order", "The next stage is not that of the next order."},
    {"stage_order_against_days", "A stage of a lower order starts later."},
    {"stage_order_gap", "An order between two stages is left out."},
    {"stage_order_repeated", "Two stages have one order."},
    {"stage_reversed", "A stage ends before it starts."},
    {"stages_overlap", "A stage starts before the last one ends."},
    {"structure_without_keys", "A structure exists and has no shape in a parameter set."},
    {"structure_without_stages", "A structure has neither stages nor parts that have some."},
    {"two_classes", "A node is of two classes, neither below the other."},
    {"two_keys_at_one_stage", "A structure has two keys at one stage in one parameter set."},
    {"two_units", "A node has two units of one dimension."},
    {"unknown_choice", "A text is none of those that are allowed."},
    {"unknown_class", "A class of our namespace is not in the vocabulary."},
    {"unknown_geometry", "A key names a geometry that is not there."},
    {"unknown_parameter_set", "A parameter set is named that is not there."},
    {"unknown_primitive", "A geometry is none of the six primitives."},
    {"unknown_process", "A process is named that is not there."},
    {"unknown_property", "A property of our namespace is not in the vocabulary."},
    {"unknown_source", "A source is named that is not there."},
    {"unknown_stage", "A stage is named that is not there."},
    {"unknown_structure", "A structure is named that is not there."},
    {"unknown_unit", "A unit is none of those that are known."},
    {"vector_length", "A list has another number of items than it must have."},
    {"wrong_value_type", "A value is of another type than its property has."},
};

}  // namespace

std::span<const ViolationKind> violation_kinds() { return kViolationKinds; }

std::vector<Violation> violations(const Graph& graph) {
  const TypedGraph typed(graph);
  Findings findings(typed);
  check_statements(findings);
  const int before = findings.size();
  check_stages(findings);
  // Where the stages are not in order, nothing can be said of what happens at them.
  if (findings.size() == before) {
    const Chronology chronology = chronology_of(typed);
    check_structures(chronology, findings);
    check_keys(chronology, findings);
    check_placement(chronology, findings);
    check_processes(chronology, findings);
  }
  check_diseases(findings);
  check_measurements(findings);
  std::vector<Violation> found = findings.take();
  std::ranges::stable_sort(found, [](const Violation& a, const Violation& b) {
    return std::tie(a.line, a.kind, a.subject) < std::tie(b.line, b.kind, b.subject);
  });
  return found;
}

}  // namespace geoprior::embryo
