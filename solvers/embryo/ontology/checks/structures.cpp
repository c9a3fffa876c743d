#include <algorithm>

#include "solvers/embryo/ontology/checks/findings.h"

namespace geoprior::embryo {

namespace {

/// A structure without a lifetime of its own has that of its parts.
void check_lifetime(const Chronology& chronology, Term structure, Findings& findings) {
  const TypedGraph& graph = findings.graph();
  const bool has_first = graph.has(structure, "existsFrom");
  const bool has_last = graph.has(structure, "existsUntil");
  if (!has_first && !has_last) {
    const std::optional<Term> part_of = graph.property("partOf");
    const bool has_parts = part_of && !graph.graph().subjects(*part_of, structure).empty();
    if (!has_parts || chronology.keys.contains(structure))
      findings.add("structure_without_stages", structure,
                   findings.quoted(structure) + " has no first and last stage");
    return;
  }
  if (!has_first || !has_last) {
    findings.add(
        "missing_property", structure,
        findings.quoted(structure) + " has no " + (has_first ? "existsUntil" : "existsFrom"));
    return;
  }
  const auto first = graph.reference(structure, "existsFrom");
  const auto last = graph.reference(structure, "existsUntil");
  if (!first || !last || chronology.lifetimes.contains(structure)) return;
  if (chronology.order_of_stage.contains(*first) && chronology.order_of_stage.contains(*last) &&
      graph.values(structure, "existsFrom").size() == 1 &&
      graph.values(structure, "existsUntil").size() == 1)
    findings.add("interval_reversed", structure,
                 findings.quoted(structure) + " exists from " + findings.quoted(*first) +
                     " until " + findings.quoted(*last) + ", which is before",
                 "existsFrom");
}

void check_relatives(const Chronology& chronology, Term structure, Findings& findings) {
  const auto own = chronology.lifetimes.find(structure);
  if (own == chronology.lifetimes.end()) return;
  const auto lifetime_of = [&](Term other) -> const Lifetime* {
    const auto found = chronology.lifetimes.find(other);
    return found == chronology.lifetimes.end() ? nullptr : &found->second;
  };
  for (const Term parent : findings.graph().references(structure, "developsFrom")) {
    const Lifetime* other = lifetime_of(parent);
    if (other != nullptr && own->second.first < other->first)
      findings.add(
          "child_before_progenitor", structure,
          findings.quoted(structure) + " begins before its progenitor " + findings.quoted(parent),
          "developsFrom");
  }
  for (const Term whole : findings.graph().references(structure, "partOf")) {
    const Lifetime* other = lifetime_of(whole);
    if (other != nullptr && (own->second.first < other->first || own->second.last > other->last))
      findings.add("part_outside_whole", structure,
                   findings.quoted(structure) + " exists when its whole " + findings.quoted(whole) +
                       " does not",
                   "partOf");
  }
}

void check_marks(Term structure, Findings& findings) {
  const TypedGraph& graph = findings.graph();
  if (graph.has(structure, "fusedWith") && !graph.has(structure, "blend"))
    findings.add("missing_property", structure,
                 findings.quoted(structure) + " is fused with another one and has no blend");
  const std::optional<Term> mirror = graph.reference(structure, "mirrorOf");
  if (mirror && graph.has(structure, "side") && graph.has(*mirror, "side") &&
      graph.text(structure, "side") == graph.text(*mirror, "side"))
    findings.add("mirror_on_one_side", structure,
                 findings.quoted(structure) + " and its mirror image " + findings.quoted(*mirror) +
                     " are of one side",
                 "mirrorOf");
}

void check_labels(const std::vector<Term>& structures, Findings& findings) {
  std::map<std::string, Term> seen;
  for (const Term structure : structures) {
    const std::string label = findings.graph().text(structure, "rdfs:label");
    if (label.empty()) continue;
    const auto [entry, is_new] = seen.try_emplace(label, structure);
    if (!is_new)
      findings.add("repeated_label", structure,
                   findings.quoted(structure) + " and " + findings.quoted(entry->second) +
                       " have the label \"" + label + "\"",
                   "rdfs:label");
  }
}

void check_cycles(const std::vector<Term>& nodes, std::string_view property, std::string_view kind,
                  Findings& findings) {
  std::map<Term, std::vector<Term>> successors;
  for (const Term node : nodes) successors[node] = findings.graph().references(node, property);
  for (const std::vector<Term>& cycle : cycles_of(successors)) {
    std::string path;
    for (const Term node : cycle) path += findings.quoted(node) + ", ";
    findings.add(kind, cycle.front(),
                 "a cycle of " + std::string(property) + ": " + path + "and again " +
                     findings.quoted(cycle.front()),
                 property);
  }
}

/// The length of one line is the unit of all positions.
void check_body(const Chronology& chronology, const std::vector<Term>& structures,
                Findings& findings) {
  std::vector<Term> bodies;
  for (const Term structure : structures) {
    if (findings.graph().flag(structure, "crownRump")) bodies.push_back(structure);
  }
  if (bodies.empty() && !chronology.keys.empty()) {
    findings.add_at("crown_rump_missing", chronology.keys.begin()->first,
                    "no structure has the crown-rump length, which positions are ratios of", 1);
  }
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    findings.add("crown_rump_twice", bodies[i],
                 findings.quoted(bodies[0]) + " has the crown-rump length already", "crownRump");
  }
  if (bodies.size() != 1) return;
  const auto keys = chronology.keys.find(bodies[0]);
  if (keys == chronology.keys.end()) return;
  for (const FoundKey& key : keys->second) {
    const int found = findings.graph().class_of(key.geometry);
    if (found < 0 || vocabulary_classes()[found].abstract ||
        vocabulary_classes()[found].name == "Line")
      continue;
    findings.add(
        "crown_rump_not_line", key.node,
        findings.quoted(bodies[0]) + ", whose length is the crown-rump length, is no line");
  }
}

}  // namespace

void check_structures(const Chronology& chronology, Findings& findings) {
  const std::vector<Term> structures = findings.graph().instances("EmbryologicalEntity");
  for (const Term structure : structures) {
    check_lifetime(chronology, structure, findings);
    check_relatives(chronology, structure, findings);
    check_marks(structure, findings);
  }
  check_labels(structures, findings);
  check_cycles(structures, "partOf", "part_of_cycle", findings);
  check_cycles(structures, "developsFrom", "develops_from_cycle", findings);
  check_cycles(findings.graph().instances("Process"), "requires", "process_requires_cycle",
               findings);
  check_body(chronology, structures, findings);
}

}  // namespace geoprior::embryo
