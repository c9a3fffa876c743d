#pragma once

#include <map>

#include "models/embryo/ontology/ontology.h"
#include "solvers/embryo/ontology/typed_graph.h"

namespace geoprior::embryo {

/// The parameters of a geometrical component without violations, in metres and ratios.
/// @param structures  places in `Ontology::structures`
Geometry geometry_of(const TypedGraph& graph, Term node, const std::map<Term, int>& structures);

}  // namespace geoprior::embryo
