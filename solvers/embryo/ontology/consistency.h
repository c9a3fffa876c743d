#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/embryo/ontology/violation.h"
#include "solvers/embryo/triples/graph.h"

namespace geoprior::embryo {

struct ViolationKind {
  std::string_view name;
  std::string_view meaning;  ///< a whole sentence
};

/// Every kind that `violations` can give, by name.
std::span<const ViolationKind> violation_kinds();

/// What is wrong in a graph, by line; empty for a consistent one.
///
/// Terms of other namespaces are left alone. One mistake gives one violation: what can only be
/// judged where a statement is well-formed is not judged where it is not.
std::vector<Violation> violations(const Graph& graph);

}  // namespace geoprior::embryo
