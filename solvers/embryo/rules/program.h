#pragma once

#include <string>
#include <string_view>

#include "solvers/embryo/rules/rule.h"

namespace geoprior::embryo {

/// What a text of rules may ask of us at most.
inline constexpr int kMostRules = 2000;
inline constexpr int kMostLiterals = 32;  ///< in one rule

/// Reads rules: Datalog with stratified negation, and with a stratified universal literal.
///
///     % Comment to the end of the line.
///     absent(E) :- partOf(E, W), absent(W).
///     active(P) :- instance(P, e:Process), not inactive(P).
///     absent(E) :- produces(_, E), inactive(P) for all produces(P, E).
///
/// Names of predicates begin with a small letter and have one or two places; variables begin with
/// a capital; `e:CS13` is the term of our namespace; `_` is any term, and not the same one twice.
/// A rule without a body states a fact. In `atom for all condition` the variables that stand in
/// nothing else of the rule run over all instances of the condition; the others are bound outside.
///
/// What it cannot do: numbers, comparisons, functions and more than two places.
///
/// @param where  name of the file, for messages
/// @throws Error  with file and line: what is no rule, a predicate with another number of places
///                than before, a variable that nothing binds, rules of which one needs that the
///                other says nothing while that needs the first (the cycle is named), a limit
RuleProgram parse_rules(std::string_view text, const std::string& where);

}  // namespace geoprior::embryo
