#pragma once

#include "solvers/embryo/rules/facts.h"
#include "solvers/embryo/rules/graph_facts.h"
#include "solvers/embryo/rules/program.h"

namespace geoprior::embryo {

struct SaturationLimits {
  int facts = 4'000'000;  ///< in all, those given with them
};

/// What follows from facts by rules: the least set that holds the facts and that every rule, read
/// as an implication, is true in; with `not` and `for all` judged stratum by stratum (the perfect
/// model of Przymusinski 1988).
///
/// Semi-naive evaluation (Bancilhon 1986): after a first pass a rule is applied again only to
/// combinations with a fact that the last pass gave. A literal is looked up by its bound places in
/// hash tables and indexes; those with more bound places come first. A rule with `atom for all
/// condition` is asked again for the instances of the condition that a new fact of `atom` belongs
/// to. Same facts in the same order each time.
///
/// @throws Error  where a predicate has another number of places in the facts, or the limit is
///                exceeded; names the rule's line
Facts saturate(const RuleProgram& program, Facts base, const SaturationLimits& limits = {});

}  // namespace geoprior::embryo
