#include <algorithm>
#include <set>

#include "solvers/embryo/ontology/checks/findings.h"

namespace geoprior::embryo {

namespace {

/// A structure may begin or end so many stages outside of its keys, with the shape of the next one.
constexpr int kUncoveredStages = 1;

/// Two keys of one structure at one stage, in one parameter set or one of them in all.
bool check_repeated(Term structure, const std::vector<FoundKey>& keys, Findings& findings) {
  const int before = findings.size();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (std::size_t k = i + 1; k < keys.size() && keys[k].order == keys[i].order; ++k) {
      if (keys[i].parameter_set && keys[k].parameter_set &&
          keys[i].parameter_set != keys[k].parameter_set)
        continue;
      const bool is_later =
          findings.graph().line(keys[k].node) >= findings.graph().line(keys[i].node);
      findings.add("two_keys_at_one_stage", keys[is_later ? k : i].node,
                   findings.quoted(structure) + " has the keys " + findings.quoted(keys[i].node) +
                       " and " + findings.quoted(keys[k].node) + " at one stage",
                   "during");
    }
  }
  return findings.size() == before;
}

bool check_inside(const Lifetime& lifetime, const std::vector<FoundKey>& keys, Findings& findings) {
  bool inside = true;
  for (const FoundKey& key : keys) {
    if (lifetime.has(key.order)) continue;
    inside = false;
    findings.add("key_outside_existence", key.node,
                 findings.quoted(key.node) + " is at a stage at which " +
                     findings.quoted(key.structure) + " does not exist",
                 "during");
  }
  return inside;
}

/// In each parameter set; the first set in which something is left open is named.
void check_coverage(const Chronology& chronology, Term structure, const Lifetime& lifetime,
                    Findings& findings) {
  for (const std::optional<Term>& set : chronology.sets) {
    const std::vector<FoundKey> keys = chronology.keys_of(structure, set);
    const std::string in_set = set ? " in " + findings.quoted(*set) : std::string();
    if (keys.empty()) {
      findings.add("structure_without_keys", structure,
                   findings.quoted(structure) + " has no key" + in_set);
      return;
    }
    const bool begins = keys.front().order <= lifetime.first + kUncoveredStages;
    const bool ends = keys.back().order >= lifetime.last_shape - kUncoveredStages;
    if (begins && ends) continue;
    findings.add("hole_in_keys", structure,
                 "the keys of " + findings.quoted(structure) + in_set +
                     (begins ? " end" : " begin") + " more than a stage " +
                     (begins ? "before" : "after") + " it does");
    return;
  }
}

std::set<Term> products_of_divisions(const TypedGraph& graph) {
  std::set<Term> products;
  for (const Term division : graph.instances("Division")) {
    for (const Term product : graph.references(division, "produces")) products.insert(product);
  }
  return products;
}

}  // namespace

void check_keys(const Chronology& chronology, Findings& findings) {
  const TypedGraph& graph = findings.graph();
  const std::set<Term> products = products_of_divisions(graph);
  const std::optional<Term> part_of = graph.property("partOf");
  for (const Term structure : graph.instances("EmbryologicalEntity")) {
    const auto found = chronology.keys.find(structure);
    const std::vector<FoundKey> keys =
        found == chronology.keys.end() ? std::vector<FoundKey>() : found->second;
    const bool is_single = check_repeated(structure, keys, findings);
    const auto lifetime = chronology.lifetimes.find(structure);
    if (lifetime == chronology.lifetimes.end()) continue;
    const bool inside = check_inside(lifetime->second, keys, findings);
    const bool has_parts = part_of && !graph.graph().subjects(*part_of, structure).empty();
    const bool needs_none = products.contains(structure) || (keys.empty() && has_parts);
    if (is_single && inside && !needs_none && !chronology.has_broken_key.contains(structure) &&
        !chronology.has_homeless_key)
      check_coverage(chronology, structure, lifetime->second, findings);
  }
}

}  // namespace geoprior::embryo
