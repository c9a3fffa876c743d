#pragma once

#include <string>

#include "models/embryo/ontology/ontology.h"
#include "solvers/embryo/ontology/read_ontology.h"
#include "solvers/embryo/triples/graph.h"

namespace geoprior::embryo {

struct OntologySelection {
  std::string parameter_set;  ///< local name; empty: only what is common to all sets
  /// Keys and processes of the chosen set are moved so many stages later: the null of a set.
  int stage_shift = 0;
};

/// Reads a graph in our vocabulary of which a model can be made (`require_model`, consistency.h);
/// what is in other namespaces is left alone.
///
/// @param where  name of the file, for messages
/// @throws Error  with the file: no stage, no crown-rump length, a parameter set that is not there,
///                a shift that leaves no stage
Ontology make_ontology(const Graph& graph, const OntologySelection& selection,
                       const std::string& where);

}  // namespace geoprior::embryo
