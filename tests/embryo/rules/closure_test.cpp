#include "solvers/embryo/rules/closure.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/random.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::embryo {
namespace {

using geoprior::test::expect_error;

/// Facts over terms t0, t1, …
struct SmallFacts {
  Facts facts;
  Term term(int i) { return facts.iri(std::string(kNamespace) + "t" + std::to_string(i)); }
  void chain(const std::string& predicate, int links) {
    for (int i = 0; i < links; ++i) facts.add(predicate, term(i), term(i + 1));
  }
};

Facts closure_of(const std::string& rules, const SmallFacts& given,
                 const SaturationLimits& limits = {}) {
  return saturate(parse_rules(rules, "my.rules"), given.facts, limits);
}

TEST(Closure, FollowsPartsToAnyDepth) {
  SmallFacts small;
  small.chain("partOf", 6);
  const Facts all = closure_of("partOf(X, Z) :- partOf(X, Y), partOf(Y, Z).", small);
  // Seven terms in a chain: 7 * 6 / 2 pairs, those of four levels and more among them.
  EXPECT_EQ(all.tuples("partOf").size(), 21u);
  EXPECT_TRUE(all.contains("partOf", small.term(0), small.term(4)));
  EXPECT_TRUE(all.contains("partOf", small.term(0), small.term(6)));
  EXPECT_FALSE(all.contains("partOf", small.term(6), small.term(0)));
}

TEST(Closure, OfARingHasEveryPair) {
  SmallFacts small;
  small.chain("next", 9);
  small.facts.add("next", small.term(9), small.term(0));
  const Facts all =
      closure_of("upto(X, Y) :- next(X, Y). upto(X, Z) :- upto(X, Y), next(Y, Z).", small);
  EXPECT_EQ(all.tuples("upto").size(), 100u);
}

TEST(Closure, JudgesNegationWhenThePredicateIsComplete) {
  SmallFacts small;
  small.chain("requires", 3);
  small.facts.add("disabled", small.term(3));
  for (int i = 0; i < 5; ++i) small.facts.add("process", small.term(i));
  const Facts all = closure_of(
      "active(P) :- process(P), not inactive(P).\n"
      "inactive(P) :- disabled(P).\n"
      "inactive(P) :- requires(P, Q), inactive(Q).\n",
      small);
  EXPECT_EQ(all.tuples("inactive").size(), 4u);
  ASSERT_EQ(all.tuples("active").size(), 1u);
  EXPECT_TRUE(all.contains("active", small.term(4)));
}

TEST(Closure, AnonymousPlacesOfANegationAreAnyTerm) {
  SmallFacts small;
  small.facts.add("fuses", small.term(0), small.term(1));
  small.facts.add("process", small.term(0));
  small.facts.add("process", small.term(1));
  const Facts all = closure_of("plain(P) :- process(P), not fuses(P, _).", small);
  EXPECT_FALSE(all.contains("plain", small.term(0)));
  EXPECT_TRUE(all.contains("plain", small.term(1)));
}

TEST(Closure, ForAllAsksForEveryInstanceThroughRecursion) {
  // t0 and t1 make t2, t2 and t3 make t4; t3 is never lost.
  SmallFacts small;
  for (const auto& [maker, made] : {std::pair{0, 2}, {1, 2}, {2, 4}, {3, 4}})
    small.facts.add("makes", small.term(maker), small.term(made));
  small.facts.add("gone", small.term(0));
  const std::string rule = "gone(E) :- makes(_, E), gone(P) for all makes(P, E).";
  EXPECT_EQ(closure_of(rule, small).tuples("gone").size(), 1u);
  small.facts.add("gone", small.term(1));
  const Facts more = closure_of(rule, small);
  EXPECT_TRUE(more.contains("gone", small.term(2)));
  EXPECT_FALSE(more.contains("gone", small.term(4)));
  small.facts.add("gone", small.term(3));
  EXPECT_TRUE(closure_of(rule, small).contains("gone", small.term(4)));
}

TEST(Closure, ForAllOfNothingHolds) {
  SmallFacts small;
  small.facts.add("thing", small.term(0));
  EXPECT_TRUE(closure_of("ok(X) :- thing(X), good(Y) for all has(X, Y).", small)
                  .contains("ok", small.term(0)));
}

TEST(Closure, ARepeatedVariableIsOneTerm) {
  SmallFacts small;
  small.facts.add("pair", small.term(0), small.term(0));
  small.facts.add("pair", small.term(0), small.term(1));
  const Facts all = closure_of("own(X) :- pair(X, X).", small);
  EXPECT_EQ(all.tuples("own").size(), 1u);
}

TEST(Closure, ConstantsNeedNotBeKnownToTheFacts) {
  SmallFacts small;
  small.facts.add("type", small.term(0), small.term(1));
  const Facts all =
      closure_of("new(e:Here). is(X) :- type(X, e:t1). no(X) :- type(X, e:Nowhere).", small);
  EXPECT_TRUE(all.contains("is", small.term(0)));
  EXPECT_TRUE(all.tuples("no").empty());
  EXPECT_EQ(all.dictionary().local_name(all.tuples("new")[0][0]), "Here");
}

TEST(Closure, StopsAtItsLimitAndNamesTheRule) {
  SmallFacts small;
  small.chain("a", 200);
  expect_error([&] { (void)closure_of("\nb(X, Y) :- a(X, _), a(Y, _).", small, {.facts = 1000}); },
               {"my.rules:2", "more than 1000 facts"});
}

TEST(Closure, RefusesAPredicateOfOtherPlacesThanTheFactsHave) {
  SmallFacts small;
  small.facts.add("a", small.term(0));
  expect_error([&] { (void)closure_of("b(X) :- a(X, _).", small); }, {"'a'", "places"});
}

// --- Against the definition ---------------------------------------------------------------------

constexpr int kDomain = 4;

/// Whether a literal holds in `all`, by trying every value of what is not bound.
class PlainJudge {
 public:
  PlainJudge(const RuleProgram& program, const Facts& all) : program_(program), all_(all) {}

  [[nodiscard]] bool holds(const RuleLiteral& literal, const std::vector<int>& values) const {
    if (literal.kind == RuleLiteral::Kind::holds) return matches(literal.atom, values);
    if (literal.kind == RuleLiteral::Kind::fails) return !matches(literal.atom, values);
    return for_all(literal, values, 0);
  }

 private:
  /// Values -1 are free in conditions.
  [[nodiscard]] bool for_all(const RuleLiteral& literal, std::vector<int> values, int from) const {
    for (int v = from; v < std::ssize(values); ++v) {
      if (values[v] >= 0) continue;
      for (int t = 0; t < kDomain; ++t) {
        values[v] = t;
        if (!for_all(literal, values, v + 1)) return false;
      }
      return true;
    }
    return !matches(literal.condition, values) || matches(literal.atom, values);
  }

  [[nodiscard]] bool matches(const Atom& atom, const std::vector<int>& values) const {
    const RulePredicate& predicate = program_.predicates[atom.predicate];
    for (const Fact& fact : all_.tuples(predicate.name)) {
      bool same = true;
      for (int i = 0; i < predicate.arity; ++i)
        same = same && (atom.places[i].kind == RuleTerm::Kind::any ||
                        fact[i] == values[atom.places[i].index]);
      if (same) return true;
    }
    return false;
  }

  const RuleProgram& program_;
  const Facts& all_;
};

/// Variables that a literal that holds binds; the others belong to a `for all`.
std::vector<bool> plainly_bound(const RuleProgram& program, const Rule& rule) {
  std::vector<bool> bound(rule.variables.size());
  for (const RuleLiteral& literal : rule.body) {
    if (literal.kind != RuleLiteral::Kind::holds) continue;
    for (int i = 0; i < program.predicates[literal.atom.predicate].arity; ++i)
      if (literal.atom.places[i].kind == RuleTerm::Kind::variable)
        bound[literal.atom.places[i].index] = true;
  }
  return bound;
}

/// Adds what a rule says of every value of its variables.
void apply_plainly(const RuleProgram& program, const Rule& rule, std::vector<int> values,
                   const std::vector<bool>& bound, std::size_t at, Facts& all) {
  for (; at < values.size(); ++at) {
    if (!bound[at]) continue;
    for (int t = 0; t < kDomain; ++t) {
      values[at] = t;
      apply_plainly(program, rule, values, bound, at + 1, all);
    }
    return;
  }
  const PlainJudge judge(program, all);
  for (const RuleLiteral& literal : rule.body)
    if (!judge.holds(literal, values)) return;
  const RulePredicate& head = program.predicates[rule.head.predicate];
  if (head.arity == 1)
    all.add(head.name, values[rule.head.places[0].index]);
  else
    all.add(head.name, values[rule.head.places[0].index], values[rule.head.places[1].index]);
}

Facts closure_by_definition(const RuleProgram& program, Facts all) {
  for (const std::vector<int>& stratum : program.strata) {
    for (int before = -1; before != all.size();) {
      before = all.size();
      for (const int r : stratum) {
        const Rule& rule = program.rules[r];
        apply_plainly(program, rule, std::vector<int>(rule.variables.size(), -1),
                      plainly_bound(program, rule), 0, all);
      }
    }
  }
  return all;
}

class RandomRules {
 public:
  explicit RandomRules(std::uint64_t seed) : random_(seed, "rules") {}

  std::string rules() {
    std::string text;
    for (int i = 0; i < 6; ++i) {
      text += atom(head()) + " :- ";
      const int literals = 1 + below(3);
      for (int l = 0; l < literals; ++l) text += (l > 0 ? ", " : "") + literal();
      text += ".\n";
    }
    return text;
  }
  Facts facts() {
    Facts out;
    for (int t = 0; t < kDomain; ++t) (void)out.iri("urn:t" + std::to_string(t));
    for (int i = 0; i < 5; ++i) {
      out.add("a", below(kDomain), below(kDomain));
      out.add("b", below(kDomain));
      out.add("c", below(kDomain), below(kDomain));
    }
    return out;
  }

 private:
  int below(int n) { return static_cast<int>(random_.below(static_cast<std::uint32_t>(n))); }
  // Of one place: b, p, r; of two: a, c, q, s.
  std::string head() { return std::string(1, "pqrs"[below(4)]); }
  std::string any_name() { return std::string(1, "abcpqrs"[below(7)]); }
  std::string variable() { return std::string(1, "XYZ"[below(3)]); }
  std::string atom(const std::string& name) {
    const bool is_single = name == "b" || name == "p" || name == "r";
    return name + "(" + variable() + (is_single ? "" : ", " + variable()) + ")";
  }
  std::string literal() {
    const int kind = below(6);
    if (kind == 0) return "not " + atom(any_name());
    if (kind == 1) return atom(any_name()) + " for all " + atom(any_name());
    return atom(any_name());
  }

  RandomStream random_;
};

std::set<std::pair<std::string, Fact>> as_set(const Facts& facts) {
  std::set<std::pair<std::string, Fact>> all;
  for (int p = 0; p < facts.predicates(); ++p)
    for (const Fact& fact : facts.relation(p).tuples()) all.emplace(facts.name(p), fact);
  return all;
}

TEST(Closure, OfRandomRulesIsThatOfTheDefinition) {
  int compared = 0, larger = 0;
  for (std::uint64_t seed = 1; compared < 50; ++seed) {
    RandomRules random(seed);
    const std::string text = random.rules();
    RuleProgram program;
    try {
      program = parse_rules(text, "my.rules");
    } catch (const Error&) {
      continue;  // unsafe, or a cycle through negation
    }
    const Facts base = random.facts();
    const Facts fast = saturate(program, base);
    ASSERT_EQ(as_set(fast), as_set(closure_by_definition(program, base))) << text;
    ++compared;
    larger += fast.size() > base.size() + 4;
  }
  EXPECT_GT(larger, 20);
}

}  // namespace
}  // namespace geoprior::embryo
