#pragma once

#include <array>
#include <string>
#include <vector>

namespace geoprior::embryo {

/// One place of an atom: a constant, a variable of its rule, or `_`, which is any term.
struct RuleTerm {
  enum class Kind { constant, variable, any };
  Kind kind = Kind::any;
  int index = 0;  ///< into RuleProgram::constants or Rule::variables
  friend bool operator==(const RuleTerm&, const RuleTerm&) = default;
};

/// A predicate over one or two terms; of those over one the second place is not used.
struct Atom {
  int predicate = 0;  ///< into RuleProgram::predicates
  std::array<RuleTerm, 2> places;
};

/// What has to hold for a rule to say something:
/// `atom`, `not atom`, or `atom for all condition` (no instance of the condition without the atom).
struct RuleLiteral {
  enum class Kind { holds, fails, for_all };
  Kind kind = Kind::holds;
  Atom atom;
  Atom condition;  ///< of for_all
};

struct Rule {
  Atom head;
  std::vector<RuleLiteral> body;
  std::vector<std::string> variables;
  int line = 0;
};

struct RulePredicate {
  std::string name;
  int arity = 0;
  int line = 0;  ///< where it was met first
};

/// Rules in the order in which they can be applied: those of a stratum ask `not` and `for all …` of
/// nothing that it or a later one says.
struct RuleProgram {
  std::vector<RulePredicate> predicates;
  std::vector<std::string> constants;  ///< IRIs
  std::vector<Rule> rules;
  std::vector<std::vector<int>> strata;  ///< numbers of rules
  std::string where;                     ///< name of the file
};

}  // namespace geoprior::embryo
