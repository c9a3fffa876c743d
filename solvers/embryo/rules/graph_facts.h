#pragma once

#include <optional>
#include <string>

#include "solvers/embryo/rules/facts.h"
#include "solvers/embryo/triples/graph.h"

namespace geoprior::embryo {

/// What of a graph rules are applied to.
struct FactSelection {
  std::optional<std::string> disease;  ///< local name; absent: the healthy case
  std::string parameter_set;           ///< local name; empty: only what is common to all sets
};

/// The facts that a graph states. Terms have the numbers that they have in the graph.
///
/// A triple with a predicate of our namespace and an IRI or a blank node as object gives
/// `name(s, o)`, one with the object `true` gives `name(s)`; rdf:type gives `type`, rdfs:subClassOf
/// `subClassOf`. Besides: `stage(S)` for the temporal entities, `next(S, T)` for those of
/// consecutive order, `selected(D)` for the disease, `subClassOf` between the classes of the
/// vocabulary. Keys and processes of other parameter sets are not there (`inSet`).
///
/// @throws Error  naming the disease that the graph does not have
Facts base_facts(const Graph& graph, const FactSelection& selection);

/// The graph and every fact as a triple, with the predicates named as in `base_facts`; a fact of
/// one place says what class a thing is of: `absent(E)` is E rdf:type e:Absent. Sorted.
Graph saturated_graph(const Graph& graph, const Facts& facts);

}  // namespace geoprior::embryo
