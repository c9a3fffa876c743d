#pragma once

#include "solvers/embryo/rules/rule.h"

namespace geoprior::embryo {

/// Orders the rules of a program into strata: strongly connected components of its predicates, each
/// after all that it depends on. O(predicates + literals).
///
/// @throws Error  with file and line where a predicate depends on its own absence; names the cycle
void order_into_strata(RuleProgram& program);

}  // namespace geoprior::embryo
