#pragma once

#include <optional>
#include <vector>

#include "models/embryo/ontology/ontology.h"
#include "solvers/embryo/rules/facts.h"
#include "solvers/embryo/triples/graph.h"

namespace geoprior::embryo {

/// What a disease, or none, comes to for an ontology's processes and structures.
struct Effects {
  std::vector<bool> inactive;             ///< by process
  std::vector<bool> absent;               ///< by structure
  std::vector<std::vector<bool>> exists;  ///< by structure and stage
};

/// Read off the saturated facts: `inactive(P)`, `absent(E)`, `exists(E, S)`.
///
/// @param graph  that the facts are of
Effects effects_of(const Facts& facts, const Graph& graph, const Ontology& ontology);

/// Without rules: what the disease itself disables and what is dormant is inactive, and nothing
/// follows from it. All structures exist in their interval, those without one while a part of them
/// does.
///
/// @param disease  number in the ontology; absent: the healthy case
Effects effects_without_rules(const Ontology& ontology, std::optional<int> disease);

}  // namespace geoprior::embryo
