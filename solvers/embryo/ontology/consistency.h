#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/embryo/ontology/violation.h"
#include "solvers/embryo/triples/graph.h"

namespace geoprior::embryo {

struct ViolationKind {
  enum class Theme { sources, time, geometry, relations };

  std::string_view name;
  Theme theme;
  bool leaves_a_model;       ///< an ontology with it can be read and looked at all the same
  std::string_view meaning;  ///< a whole sentence
};

/// What is done with violations that leave a model; the others are always refused.
enum class Mistakes { refused, counted };

/// Every kind that `violations` can give, by name.
std::span<const ViolationKind> violation_kinds();

/// What is wrong in a graph, by line; empty for a consistent one.
///
/// Terms of other namespaces are left alone. One mistake gives one violation: what can only be
/// judged where a statement is well-formed is not judged where it is not.
std::vector<Violation> violations(const Graph& graph);

/// Of a name that `violations` gives.
const ViolationKind& violation_kind(std::string_view name);

/// @throws Error  with file and line: the first of a graph's violations that is refused, and how
///                many more are
void require_model(const Graph& graph, const std::vector<Violation>& found, Mistakes mistakes);

}  // namespace geoprior::embryo
