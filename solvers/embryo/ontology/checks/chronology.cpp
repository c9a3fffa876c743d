#include <algorithm>

#include "solvers/embryo/ontology/checks/findings.h"

namespace geoprior::embryo {

namespace {

std::optional<int> order_at(const TypedGraph& graph, const Chronology& chronology, Term node,
                            std::string_view property) {
  const std::optional<Term> stage = graph.reference(node, property);
  if (!stage || graph.values(node, property).size() != 1) return std::nullopt;
  const auto found = chronology.order_of_stage.find(*stage);
  if (found == chronology.order_of_stage.end()) return std::nullopt;
  return found->second;
}

void add_keys(const TypedGraph& graph, Chronology& out) {
  for (const Term node : graph.instances("SpatioTemporalEntity")) {
    const std::vector<Term> structures = graph.references(node, "of");
    if (structures.size() != 1) {
      out.has_homeless_key = true;
      continue;
    }
    const std::optional<int> order = order_at(graph, out, node, "during");
    const std::vector<Term> geometries = graph.references(node, "geometry");
    const bool has_set = graph.has(node, "inSet");
    const std::optional<Term> set = graph.reference(node, "inSet");
    if (!order || geometries.size() != 1 || has_set != set.has_value()) {
      out.has_broken_key[structures[0]] = true;
      continue;
    }
    out.keys[structures[0]].push_back({node, structures[0], geometries[0], *order, set});
  }
  for (auto& entry : out.keys) std::ranges::stable_sort(entry.second, {}, &FoundKey::order);
}

/// A whole that is divided gives its products their shape.
void extend_wholes(const TypedGraph& graph, Chronology& out) {
  for (const Term division : graph.instances("Division")) {
    for (const Term whole : graph.references(division, "actsOn")) {
      const auto lifetime = out.lifetimes.find(whole);
      if (lifetime == out.lifetimes.end()) continue;
      for (const Term product : graph.references(division, "produces")) {
        const auto of_product = out.lifetimes.find(product);
        if (of_product == out.lifetimes.end()) continue;
        lifetime->second.last_shape =
            std::max(lifetime->second.last_shape, of_product->second.last);
      }
    }
  }
}

}  // namespace

std::vector<FoundKey> Chronology::keys_of(Term structure, const std::optional<Term>& set) const {
  std::vector<FoundKey> out;
  const auto found = keys.find(structure);
  if (found == keys.end()) return out;
  for (const FoundKey& key : found->second) {
    if (!key.parameter_set || key.parameter_set == set) out.push_back(key);
  }
  return out;
}

Chronology chronology_of(const TypedGraph& graph) {
  Chronology out;
  for (const Term stage : graph.instances("TemporalEntity")) {
    const std::optional<Term> order = graph.value(stage, "order");
    if (order && is_integer(graph.graph().dictionary(), *order))
      out.order_of_stage[stage] = static_cast<int>(*number_of(graph.graph().dictionary(), *order));
  }
  for (const Term structure : graph.instances("EmbryologicalEntity")) {
    const std::optional<int> first = order_at(graph, out, structure, "existsFrom");
    const std::optional<int> last = order_at(graph, out, structure, "existsUntil");
    if (first && last && *first <= *last) out.lifetimes[structure] = {*first, *last, *last};
  }
  add_keys(graph, out);
  extend_wholes(graph, out);
  for (const Term set : graph.instances("ParameterSet")) out.sets.emplace_back(set);
  if (out.sets.empty()) out.sets.emplace_back();
  return out;
}

}  // namespace geoprior::embryo
