#include "solvers/embryo/rules/program.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/testbed/scratch_folder.h"

namespace geoprior::embryo {
namespace {

using geoprior::test::expect_error;

void expect_rule_error(const std::string& text, std::initializer_list<std::string> parts) {
  SCOPED_TRACE(text);
  expect_error([&] { (void)parse_rules(text, "my.rules"); }, parts);
}

TEST(RuleText, HasHeadsLiteralsConstantsAndComments) {
  const RuleProgram program = parse_rules(
      "% what is absent\n"
      "absent(E) :- produces(_, E), inactive(P) for all produces(P, E).\n"
      "active(P) :- instance(P, e:Process), not inactive(P).  % and what runs\n"
      "stage(e:CS13).",
      "my.rules");
  ASSERT_EQ(program.rules.size(), 3u);
  EXPECT_EQ(program.rules[0].line, 2);
  EXPECT_EQ(program.rules[0].body[1].kind, RuleLiteral::Kind::for_all);
  EXPECT_EQ(program.rules[1].body[1].kind, RuleLiteral::Kind::fails);
  EXPECT_TRUE(program.rules[2].body.empty());
  EXPECT_EQ(program.constants[1], "urn:geoprior:embryo#CS13");
  EXPECT_EQ(program.rules[0].variables, (std::vector<std::string>{"E", "P"}));
}

TEST(RuleText, HasStrataInWhichNegationLooksBackOnly) {
  const RuleProgram program = parse_rules(
      "c(X) :- a(X), not b(X).\n"
      "b(X) :- a(X), d(X, X).\n"
      "d(X, Z) :- d(X, Y), d(Y, Z).\n",
      "my.rules");
  ASSERT_EQ(program.strata.size(), 3u);
  EXPECT_EQ(program.strata[0], std::vector<int>{2});
  EXPECT_EQ(program.strata[1], std::vector<int>{1});
  EXPECT_EQ(program.strata[2], std::vector<int>{0});
}

TEST(RuleText, ThatIsNoRuleIsNamedWithItsLine) {
  expect_rule_error("p(X) :- q(X).\np(X) : q(X).", {"my.rules:2", "unexpected ':'"});
  expect_rule_error("p(X) :- q(X)", {"my.rules:1", "end of the text", "'.'"});
  expect_rule_error("\n\nP(x) :- q(X).", {"my.rules:3", "unexpected 'P'", "small letter"});
  expect_rule_error("p(X) :- q(x).", {"unexpected 'x'", "Variable"});
  expect_rule_error("p(X) :- q(X), .", {"unexpected '.'", "predicate"});
  expect_rule_error("p(X) :- not not q(X).", {"unexpected 'not'"});
  expect_rule_error("p(X) :- q(X) for r(X).", {"unexpected 'r'", "'all'"});
  expect_rule_error("p(X) :- q(X), r(e:).", {"'e:' without a name"});
  expect_rule_error("p(X) :- q(X), r(\"a\").", {"unexpected '\"'"});
  expect_rule_error("p(X) :- q(X)\x01.", {"unexpected byte 1"});
  expect_rule_error("p() :- q(X).", {"unexpected ')'"});
  expect_rule_error("p(X, Y, Z) :- q(X).", {"three places"});
  expect_rule_error("p", {"end of the text", "'('"});
}

TEST(RuleText, RefusesVariablesThatNothingBinds) {
  expect_rule_error("\np(X, Y) :- q(X).", {"my.rules:2", "unsafe variable 'Y' of 'p'"});
  expect_rule_error("p(X) :- q(X), not r(Y).", {"unsafe variable 'Y' of 'r'"});
  expect_rule_error("p(X) :- not q(X).", {"unsafe variable 'X'"});
  expect_rule_error("p(X) :- q(_), r(Y) for all s(Y, X).", {"unsafe variable 'X' of 'p'"});
  expect_rule_error("p(X) :- q(X), r(Z) for all s(Y, X).", {"unsafe variable 'Z' of 'r'"});
  expect_rule_error("p(X) :- q(X), r(Y) for all s(Y, X), t(Y) for all s(Y, X).",
                    {"'Y' in two 'for all'"});
  expect_rule_error("p(_) :- q(X).", {"'_' in the head"});
  EXPECT_NO_THROW((void)parse_rules("p(X) :- q(X), not r(X, _).", "my.rules"));
}

TEST(RuleText, GivesAPredicateOneNumberOfPlaces) {
  expect_rule_error("p(X) :- q(X, Y).\nr(X) :- q(X).",
                    {"my.rules:2", "'q' with 1", "in line 1, with 2"});
}

TEST(RuleText, NamesTheCycleThroughNegation) {
  expect_rule_error(
      "absent(E) :- produces(P, E), inactive(P).\n"
      "inactive(P) :- needs(P, E), not present(E).\n"
      "present(E) :- thing(E), not absent(E).\n",
      {"my.rules:", "cycle through negation", "inactive -> not present -> not absent -> inactive"});
  expect_rule_error("p(X) :- q(X), not p(X).", {"my.rules:1", "p -> not p"});
  expect_rule_error("p(X) :- q(X), r(Y) for all p(Y).", {"p -> not p"});
  // What a universal literal asks for may be of its own stratum: more of it only helps.
  EXPECT_NO_THROW((void)parse_rules("p(X) :- q(X), p(Y) for all r(Y, X).", "my.rules"));
}

TEST(RuleText, HasALimitOfRulesAndLiterals) {
  std::string many;
  for (int i = 0; i <= kMostRules; ++i) many += "p(X) :- q(X).\n";
  expect_rule_error(many, {"more than 2000 rules"});
  std::string body = "p(X) :- q(X)";
  for (int i = 0; i < kMostLiterals; ++i) body += ", q(X)";
  expect_rule_error(body + ".", {"more than 32 literals"});
}

}  // namespace
}  // namespace geoprior::embryo
