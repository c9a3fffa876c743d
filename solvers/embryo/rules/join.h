#pragma once

#include <array>
#include <vector>

#include "solvers/embryo/rules/facts.h"
#include "solvers/embryo/rules/program.h"

namespace geoprior::embryo {

/// What one place of a literal does with a tuple's term.
struct JoinPlace {
  enum class Does { nothing, compare_constant, compare_variable, bind };
  Does does = Does::nothing;
  int index = 0;  ///< the constant's term, or the variable
};

/// One literal in the order in which it is looked up.
struct JoinStep {
  enum class Kind { each, none, for_all };
  /// Of a predicate that its own stratum says: what the last pass gave, what was there before it,
  /// or both.
  enum class Range { all, fresh, before };
  Kind kind = Kind::each;
  Range range = Range::all;
  int relation = 0;
  std::array<JoinPlace, 2> places;
  int look_up = -1;  ///< place whose index is walked; -1: none, 2: the whole tuple is known
  /// Of for_all: what must be there for each tuple of `relation`.
  int inner = 0;
  std::array<JoinPlace, 2> inner_places;
  int inner_look_up = -1;
};

/// A rule, or a rule for the fresh facts of one of its literals, as a nest of loops.
struct Join {
  std::vector<JoinStep> steps;
  int head = 0;
  std::array<JoinPlace, 2> head_places;
  int variables = 0;
  int line = 0;
};

/// Numbers of a program's predicates and constants among the facts.
struct ProgramTerms {
  std::vector<int> relations;
  std::vector<Term> constants;
};

/// Literals that hold in the order of most bound places, `not` and `for all` as soon as they can be
/// judged. Makes the indexes that it walks.
///
/// @param fresh       literal whose fresh facts are joined, or -1: all facts
/// @param is_of_stratum  by predicate of the program: whether its stratum says it
Join make_join(const RuleProgram& program, const Rule& rule, int fresh,
               const std::vector<bool>& is_of_stratum, const ProgramTerms& terms, Facts& facts);

}  // namespace geoprior::embryo
