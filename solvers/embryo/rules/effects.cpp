#include "solvers/embryo/rules/effects.h"

#include <string>

namespace geoprior::embryo {
namespace {

std::optional<Term> local_term(const Graph& graph, const std::string& name) {
  return graph.dictionary().find_local(name);
}

/// Structures without an interval take those of their parts, however deep these are.
void spread_to_wholes(const Ontology& ontology, std::vector<std::vector<bool>>& exists) {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t part = 0; part < ontology.structures.size(); ++part) {
      for (const int whole : ontology.structures[part].part_of) {
        if (ontology.structures[whole].from_stage) continue;
        for (std::size_t s = 0; s < ontology.stages.size(); ++s) {
          if (!exists[part][s] || exists[whole][s]) continue;
          exists[whole][s] = changed = true;
        }
      }
    }
  }
}

}  // namespace

Effects effects_of(const Facts& facts, const Graph& graph, const Ontology& ontology) {
  Effects effects;
  for (const ProcessEntry& process : ontology.processes) {
    const auto term = local_term(graph, process.name);
    effects.inactive.push_back(term && facts.contains("inactive", *term));
  }
  std::vector<std::optional<Term>> stages;
  for (const Stage& stage : ontology.stages) stages.push_back(local_term(graph, stage.name));
  for (const Structure& structure : ontology.structures) {
    const auto term = local_term(graph, structure.name);
    effects.absent.push_back(term && facts.contains("absent", *term));
    std::vector<bool>& exists = effects.exists.emplace_back();
    for (const auto& stage : stages)
      exists.push_back(term && stage && facts.contains("exists", *term, *stage));
  }
  return effects;
}

Effects effects_without_rules(const Ontology& ontology, std::optional<int> disease) {
  Effects effects;
  for (const ProcessEntry& process : ontology.processes)
    effects.inactive.push_back(process.dormant);
  if (disease) {
    for (const int enabled : ontology.diseases[*disease].enables) effects.inactive[enabled] = false;
    for (const int disabled : ontology.diseases[*disease].disables)
      effects.inactive[disabled] = true;
  }
  effects.absent.assign(ontology.structures.size(), false);
  for (const Structure& structure : ontology.structures) {
    std::vector<bool>& exists = effects.exists.emplace_back(ontology.stages.size(), false);
    if (!structure.from_stage || !structure.until_stage) continue;
    for (int s = *structure.from_stage; s <= *structure.until_stage; ++s) exists[s] = true;
  }
  spread_to_wholes(ontology, effects.exists);
  return effects;
}

}  // namespace geoprior::embryo
