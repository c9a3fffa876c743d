#include "solvers/embryo/ontology/consistency.h"

#include <algorithm>
#include <tuple>

#include "core/error.h"
#include "solvers/embryo/ontology/checks/findings.h"

namespace geoprior::embryo {

namespace {

using Theme = ViolationKind::Theme;

constexpr ViolationKind kViolationKinds[] = {
    {"anchor_cycle", Theme::geometry, false, "Ducts are anchored on each other in a circle."},
    {"anchor_on_no_structure", Theme::geometry, false,
     "A duct is anchored on a thing that is no structure."},
    {"axis_parallel_to_up", Theme::geometry, false,
     "The two directions that turn a shape are parallel."},
    {"axis_zero", Theme::geometry, false, "A direction has no length."},
    {"child_before_progenitor", Theme::time, true,
     "A structure begins before what it develops from."},
    {"crown_rump_missing", Theme::geometry, false, "No structure has the crown-rump length."},
    {"crown_rump_not_line", Theme::geometry, false,
     "The structure that has the crown-rump length is no line."},
    {"crown_rump_twice", Theme::geometry, false, "Two structures have the crown-rump length."},
    {"develops_from_cycle", Theme::relations, false,
     "Structures develop from each other in a circle."},
    {"disease_contradicts_itself", Theme::relations, true,
     "A disease enables and disables one process."},
    {"disease_unknown_process", Theme::relations, false,
     "A disease names a process that is not there."},
    {"disease_without_effect", Theme::relations, true, "A disease disables and enables nothing."},
    {"division_positive_no_product", Theme::relations, false,
     "The product on the side of the normal is not produced."},
    {"division_products", Theme::relations, false, "A division has not exactly two products."},
    {"division_wholes", Theme::relations, false, "A division divides more than one structure."},
    {"duct_with_two_ends", Theme::geometry, false,
     "An end of a duct is on a structure and free as well."},
    {"duct_without_end", Theme::geometry, false, "An end of a duct is nowhere."},
    {"egg_out_of_range", Theme::geometry, false,
     "An egg is more than half as wide at one pole as in its middle."},
    {"fixation_without_duct", Theme::geometry, true, "A fixation acts on what is no duct."},
    {"frame_cycle", Theme::geometry, false,
     "Structures are placed relative to each other in a circle."},
    {"fusion_of_one", Theme::relations, true, "A fusion has one structure only."},
    {"hole_in_keys", Theme::time, true,
     "The keys of a structure leave more than a stage open at an end."},
    {"interval_reversed", Theme::time, false, "A structure ends before it begins."},
    {"key_outside_existence", Theme::time, true,
     "A key is at a stage at which its structure does not exist."},
    {"key_with_two_geometries", Theme::geometry, false, "A key has more than one geometry."},
    {"key_with_two_stages", Theme::relations, false, "A key is at more than one stage."},
    {"key_with_two_structures", Theme::relations, false, "A key is of more than one structure."},
    {"key_without_geometry", Theme::geometry, false, "A key has no geometry."},
    {"key_without_stage", Theme::time, false, "A key is at no stage."},
    {"key_without_structure", Theme::relations, false, "A key is of no structure."},
    {"measurement_reversed", Theme::relations, true, "The low of a measurement is above its high."},
    {"measurement_without_value", Theme::relations, false,
     "A measurement has neither a range nor a mean."},
    {"mirror_on_one_side", Theme::relations, true,
     "A structure and its mirror image are of one side."},
    {"misplaced_property", Theme::relations, false,
     "A node has a property that its class has not."},
    {"missing_property", Theme::relations, false,
     "A node lacks a property that its class requires."},
    {"missing_source", Theme::sources, true, "A node with numbers has no source."},
    {"missing_unit", Theme::sources, false,
     "A node with a length, an angle or a day has no unit of it."},
    {"negative_number", Theme::geometry, false, "A number is below zero that may not be."},
    {"no_class", Theme::relations, false, "A node has properties of the vocabulary and no class."},
    {"not_finite", Theme::geometry, false, "A number is infinite or not a number."},
    {"not_positive", Theme::geometry, false, "A number is not above zero that must be."},
    {"part_of_cycle", Theme::relations, false, "Structures are part of each other in a circle."},
    {"part_outside_whole", Theme::time, true, "A part exists when its whole does not."},
    {"placed_on_absent", Theme::geometry, false,
     "A geometry is placed on a structure that is not there at its stage."},
    {"primitive_changes", Theme::geometry, false,
     "The keys of a structure are of different primitives."},
    {"process_requires_cycle", Theme::relations, false,
     "Processes require each other in a circle."},
    {"process_span_empty", Theme::time, false,
     "A process that takes time begins and ends at one stage."},
    {"process_span_reversed", Theme::time, false, "A process ends before it begins."},
    {"process_unknown_structure", Theme::relations, false,
     "A process names a structure that is not there."},
    {"product_begins_elsewhere", Theme::time, false,
     "A product does not begin where its division ends."},
    {"product_with_keys", Theme::geometry, false, "A product of a division has keys of its own."},
    {"repeated_label", Theme::relations, true, "Two structures have one label."},
    {"repeated_property", Theme::relations, false,
     "A property has several values that may have one."},
    {"stage_next_against_order", Theme::time, false,
     "The next stage is not that of the next order."},
    {"stage_order_against_days", Theme::time, false, "A stage of a lower order starts later."},
    {"stage_order_gap", Theme::time, false, "An order between two stages is left out."},
    {"stage_order_repeated", Theme::time, false, "Two stages have one order."},
    {"stage_reversed", Theme::time, false, "A stage ends before it starts."},
    {"stages_overlap", Theme::time, false, "A stage starts before the last one ends."},
    {"structure_without_keys", Theme::geometry, false,
     "A structure exists and has no shape in a parameter set."},
    {"structure_without_stages", Theme::time, false,
     "A structure has neither stages nor parts that have some."},
    {"two_classes", Theme::relations, false, "A node is of two classes, neither below the other."},
    {"two_keys_at_one_stage", Theme::time, false,
     "A structure has two keys at one stage in one parameter set."},
    {"two_units", Theme::sources, false, "A node has two units of one dimension."},
    {"unknown_choice", Theme::relations, false, "A text is none of those that are allowed."},
    {"unknown_class", Theme::relations, false,
     "A class of our namespace is not in the vocabulary."},
    {"unknown_geometry", Theme::geometry, false, "A key names a geometry that is not there."},
    {"unknown_parameter_set", Theme::relations, false,
     "A parameter set is named that is not there."},
    {"unknown_primitive", Theme::geometry, false, "A geometry is none of the six primitives."},
    {"unknown_process", Theme::relations, false, "A process is named that is not there."},
    {"unknown_property", Theme::relations, true,
     "A property of our namespace is not in the vocabulary."},
    {"unknown_source", Theme::sources, true, "A source is named that is not there."},
    {"unknown_stage", Theme::time, false, "A stage is named that is not there."},
    {"unknown_structure", Theme::relations, false, "A structure is named that is not there."},
    {"unknown_unit", Theme::sources, false, "A unit is none of those that are known."},
    {"vector_length", Theme::geometry, false,
     "A list has another number of items than it must have."},
    {"wrong_value_type", Theme::relations, false,
     "A value is of another type than its property has."},
};

}  // namespace

std::span<const ViolationKind> violation_kinds() { return kViolationKinds; }

const ViolationKind& violation_kind(std::string_view name) {
  return *std::ranges::find(kViolationKinds, name, &ViolationKind::name);
}

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

void require_model(const Graph& graph, const std::vector<Violation>& found, Mistakes mistakes) {
  const auto refused = [&](const Violation& one) {
    return mistakes == Mistakes::refused || !violation_kind(one.kind).leaves_a_model;
  };
  const auto first = std::ranges::find_if(found, refused);
  if (first == found.end()) return;
  const auto more = std::ranges::count_if(first + 1, found.end(), refused);
  throw Error(first->message + (more > 0 ? ", and " + std::to_string(more) + " more" : ""),
              graph.place(first->line));
}

}  // namespace geoprior::embryo
