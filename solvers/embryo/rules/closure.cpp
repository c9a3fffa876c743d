#include "solvers/embryo/rules/closure.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "solvers/embryo/rules/join.h"

namespace geoprior::embryo {
namespace {

using Does = JoinPlace::Does;
using Range = JoinStep::Range;

/// Tuples of a relation by age: [0, before) are old, [before, now) came in the last pass.
struct Ages {
  int before = 0, now = 0;
};

/// Runs joins over the facts, which they add to.
class JoinRunner {
 public:
  JoinRunner(Facts& facts, int most, const std::string& where)
      : facts_(facts),
        most_(most),
        where_(where),
        count_(facts.size()),
        ages_(facts.predicates()) {}

  void run(const Join& join) {
    join_ = &join;
    values_.assign(join.variables, -1);
    go(0);
  }
  /// What is there now is the fresh part of the next pass; false where there is nothing new.
  bool advance(const std::vector<int>& relations) {
    bool is_new = false;
    for (const int r : relations) {
      Ages& ages = ages_[r];
      ages = {ages.now, facts_.relation(r).size()};
      is_new = is_new || ages.now > ages.before;
    }
    return is_new;
  }

 private:
  void go(std::size_t at) {
    if (at == join_->steps.size()) return say_head();
    const JoinStep& step = join_->steps[at];
    if (step.kind == JoinStep::Kind::each) {
      const Ages range = range_of(step);
      visit(step.relation, step.look_up, step.places, range, [&] {
        go(at + 1);
        return true;
      });
      return;
    }
    const Ages all{0, facts_.relation(step.relation).size()};
    bool fits = true;
    visit(step.relation, step.look_up, step.places, all, [&] {
      fits = step.kind == JoinStep::Kind::for_all && has(step.inner, step);
      return fits;
    });
    if (fits) go(at + 1);
  }

  [[nodiscard]] Ages range_of(const JoinStep& step) const {
    const Ages& ages = ages_[step.relation];
    if (step.range == Range::fresh) return ages;
    return {0, step.range == Range::before ? ages.before : facts_.relation(step.relation).size()};
  }

  bool has(int relation, const JoinStep& step) {
    bool found = false;
    const Ages all{0, facts_.relation(relation).size()};
    visit(relation, step.inner_look_up, step.inner_places, all, [&] {
      found = true;
      return false;
    });
    return found;
  }

  [[nodiscard]] Term value(const JoinPlace& place) const {
    return place.does == Does::compare_constant ? place.index : values_[place.index];
  }

  bool fits(const std::array<JoinPlace, 2>& places, const Fact& fact) {
    for (int i = 0; i < 2; ++i) {
      const JoinPlace& place = places[i];
      if (place.does == Does::bind)
        values_[place.index] = fact[i];
      else if (place.does != Does::nothing && value(place) != fact[i])
        return false;
    }
    return true;
  }

  /// Calls `action` for the tuples of `range` that fit, with their variables bound, while it says
  /// to go on.
  template <class Action>
  void visit(int number, int look_up, const std::array<JoinPlace, 2>& places, Ages range,
             const Action& action) {
    // The table of relations does not grow while joins run; a relation's tuples do.
    const Relation& relation = facts_.relation(number);
    if (look_up == 2) {
      const bool is_single = places[1].does == Does::nothing && relation.arity() == 1;
      if (relation.contains({value(places[0]), is_single ? -1 : value(places[1])})) action();
    } else if (look_up >= 0) {
      for (int t = relation.newest(look_up, value(places[look_up])); t >= range.before;
           t = relation.older(look_up, t)) {
        const Fact fact = relation[t];
        if (t < range.now && fits(places, fact) && !action()) return;
      }
    } else {
      for (int t = range.before; t < range.now; ++t) {
        const Fact fact = relation[t];
        if (fits(places, fact) && !action()) return;
      }
    }
  }

  void say_head() {
    Fact fact{value(join_->head_places[0]), -1};
    Relation& relation = facts_.relation(join_->head);
    if (relation.arity() == 2) fact[1] = value(join_->head_places[1]);
    if (!relation.add(fact)) return;
    if (++count_ > most_)
      throw Error("more than " + std::to_string(most_) + " facts",
                  where_ + ":" + std::to_string(join_->line), "rules and ontologies that say less");
  }

  Facts& facts_;
  int most_;
  const std::string& where_;
  int count_;
  std::vector<Ages> ages_;  ///< by relation
  const Join* join_ = nullptr;
  std::vector<Term> values_;
};

/// The joins of a stratum: each rule once, and each for the fresh facts of its own stratum.
struct StratumJoins {
  std::vector<Join> first, again;
  std::vector<int> relations;  ///< that the stratum says
};

StratumJoins joins_of(const RuleProgram& program, const std::vector<int>& stratum,
                      const ProgramTerms& terms, Facts& facts) {
  StratumJoins joins;
  std::vector<bool> is_of_stratum(program.predicates.size());
  for (const int r : stratum) is_of_stratum[program.rules[r].head.predicate] = true;
  for (int p = 0; p < std::ssize(is_of_stratum); ++p)
    if (is_of_stratum[p]) joins.relations.push_back(terms.relations[p]);
  for (const int r : stratum) {
    const Rule& rule = program.rules[r];
    joins.first.push_back(make_join(program, rule, -1, is_of_stratum, terms, facts));
    for (int l = 0; l < std::ssize(rule.body); ++l)
      if (rule.body[l].kind != RuleLiteral::Kind::fails &&
          is_of_stratum[rule.body[l].atom.predicate])
        joins.again.push_back(make_join(program, rule, l, is_of_stratum, terms, facts));
  }
  return joins;
}

ProgramTerms number_terms(const RuleProgram& program, Facts& facts) {
  ProgramTerms terms;
  for (const std::string& constant : program.constants)
    terms.constants.push_back(facts.iri(constant));
  for (const RulePredicate& predicate : program.predicates)
    terms.relations.push_back(facts.predicate(predicate.name, predicate.arity));
  return terms;
}

}  // namespace

Facts saturate(const RuleProgram& program, Facts base, const SaturationLimits& limits) {
  const ProgramTerms terms = number_terms(program, base);
  JoinRunner runner(base, limits.facts, program.where);
  for (const std::vector<int>& stratum : program.strata) {
    const StratumJoins joins = joins_of(program, stratum, terms, base);
    for (const Join& join : joins.first) runner.run(join);
    while (runner.advance(joins.relations))
      for (const Join& join : joins.again) runner.run(join);
  }
  return base;
}

}  // namespace geoprior::embryo
