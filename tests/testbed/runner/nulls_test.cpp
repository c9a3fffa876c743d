// Claims that can fail: what the null of a claim says of it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "testbed/runner/judgement/claims.h"

namespace geoprior {
namespace {

using ::testing::HasSubstr;

VariantRecord measured(const std::string& name, std::vector<double> errors,
                       const std::string& role = "method") {
  VariantRecord v;
  v.name = name;
  v.role = role;
  v.status = "done";
  for (std::size_t i = 0; i < errors.size(); ++i) v.frames.push_back({double(i), {}});
  v.metrics["error"] = {"m", "", "lower_is_better", std::move(errors)};
  return v;
}

CaseRecord case_of(std::vector<VariantRecord> variants, const std::string& name = "default") {
  CaseRecord in;
  in.name = name;
  in.parameter_name = "time";
  in.parameter_unit = "s";
  in.variants = std::move(variants);
  return in;
}

RunRecord run_of(std::vector<VariantRecord> variants) {
  RunRecord run;
  run.cases = {case_of(std::move(variants))};
  return run;
}

/// "error of a is at most `limit`", which `null` must fail by more than 0.1.
ClaimSpec at_most(double limit, const std::string& null) {
  ClaimSpec claim;
  claim.text = "small";
  claim.metric = "error";
  claim.variant = "a";
  claim.value = limit;
  claim.null = null;
  claim.metric_tolerance = {0.1, 0};
  return claim;
}

ClaimRecord decided(const ClaimSpec& claim, const RunRecord& run) {
  Experiment experiment;
  experiment.claims = {claim};
  return decide_claims(experiment, run).at(0);
}

Discrimination verdict(const ClaimSpec& claim, const RunRecord& run) {
  return decided(claim, run).null.verdict;
}

TEST(Nulls, ANullThatFailsTheClaimMakesItDiscriminate) {
  const ClaimRecord record =
      decided(at_most(2, "n"), run_of({measured("a", {1, 1}), measured("n", {1, 3})}));
  EXPECT_TRUE(record.holds);
  EXPECT_EQ(record.null.verdict, Discrimination::discriminates);
  EXPECT_EQ(record.null.variant, "n");
  EXPECT_EQ(record.null.left, 3);
  EXPECT_EQ(record.null.right, 2);
  EXPECT_THAT(record.null.detail, HasSubstr("error of n (max): 3 <= 2 m"));
  EXPECT_TRUE(is_sound(record));
}

TEST(Nulls, OneThatPassesOrFailsByNoMoreThanTheToleranceMakesItVoid) {
  const auto with = [](double null) { return run_of({measured("a", {1}), measured("n", {null})}); };
  EXPECT_EQ(verdict(at_most(2, "n"), with(2)), Discrimination::is_void);
  EXPECT_EQ(verdict(at_most(2, "n"), with(2.09)), Discrimination::is_void);
  EXPECT_EQ(verdict(at_most(2, "n"), with(2.11)), Discrimination::discriminates);
  ClaimSpec relative = at_most(2, "n");
  relative.metric_tolerance = {0, 0.5};
  EXPECT_EQ(verdict(relative, with(3.9)), Discrimination::is_void)
      << "1.9 is less than half of 3.9";
  EXPECT_EQ(verdict(relative, with(4.1)), Discrimination::discriminates);
}

TEST(Nulls, OnlyTheVariantIsReplaced) {
  ClaimSpec claim = at_most(0, "n");
  claim.value.reset();
  claim.of = "b";
  claim.factor = 0.5;
  claim.offset = 1;
  claim.of_reduce = Reduction::min;
  const RunRecord run =
      run_of({measured("a", {1, 2}), measured("b", {4, 2}), measured("n", {2, 2.5})});
  const ClaimRecord record = decided(claim, run);
  EXPECT_EQ(record.right, 2);
  EXPECT_EQ(record.null.right, 2) << "0.5 min(b) + 1 for both";
  EXPECT_EQ(record.null.left, 2.5);
}

TEST(Nulls, TheYardstickAsNullAsksForAMarginOfTheClaimsOwn) {
  ClaimSpec claim = at_most(0, "b");
  claim.value.reset();
  claim.of = "b";
  claim.is = Comparison::less;
  const auto against = [](double b) { return run_of({measured("a", {1}), measured("b", {b})}); };
  EXPECT_EQ(verdict(claim, against(1.05)), Discrimination::is_void);
  EXPECT_EQ(verdict(claim, against(1.2)), Discrimination::discriminates);
  claim.factor = 0.2;
  EXPECT_EQ(verdict(claim, against(0)), Discrimination::is_void) << "0 against 0 says nothing";
  EXPECT_EQ(verdict(claim, against(10)), Discrimination::discriminates);
}

TEST(Nulls, FrameByFrameAtLeastHalfOfTheFramesMustFail) {
  ClaimSpec claim = at_most(2, "n");
  claim.reduce = Reduction::every;
  const auto with = [](std::vector<double> null) {
    return run_of({measured("a", {1, 1, 1, 1}), measured("n", std::move(null))});
  };
  EXPECT_EQ(verdict(claim, with({1, 1, 1, 9})), Discrimination::is_void);
  EXPECT_EQ(verdict(claim, with({1, 1, 9, 9})), Discrimination::discriminates);
  EXPECT_EQ(verdict(claim, with({1, 2.05, 2.05, 9})), Discrimination::is_void)
      << "two of them by less than the tolerance";
}

TEST(Nulls, BesideAKnownShortfallTheNullMustBeWorse) {
  ClaimSpec claim = at_most(1, "n");
  claim.known_shortfall = "too coarse";
  const auto with = [](double null) { return run_of({measured("a", {2}), measured("n", {null})}); };
  EXPECT_EQ(verdict(claim, with(1.5)), Discrimination::is_void);
  EXPECT_EQ(verdict(claim, with(2.05)), Discrimination::is_void);
  EXPECT_EQ(verdict(claim, with(3)), Discrimination::discriminates);
}

TEST(Nulls, WithoutAValueTheyLeaveTheClaimUndecided) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const ClaimSpec claim = at_most(2, "n");
  EXPECT_EQ(verdict(claim, run_of({measured("a", {1}), measured("n", {none})})),
            Discrimination::undecided);
  EXPECT_EQ(verdict(claim, run_of({measured("a", {1})})), Discrimination::undecided);
  RunRecord failed = run_of({measured("a", {1}), measured("n", {3})});
  failed.cases[0].variants[1].status = "failed";
  failed.cases[0].variants[1].error = "does not converge";
  const ClaimRecord record = decided(claim, failed);
  EXPECT_EQ(record.null.verdict, Discrimination::undecided);
  EXPECT_THAT(record.null.detail, HasSubstr("'n' failed after 1 frame: does not converge"));
  EXPECT_FALSE(is_sound(record));
  std::swap(failed.cases[0].variants[0].status, failed.cases[0].variants[1].status);
  EXPECT_EQ(verdict(claim, failed), Discrimination::undecided) << "the variant itself failed";
}

TEST(Nulls, WhoNamesNoneIsUnaskedUnlessExempt) {
  ClaimSpec claim = at_most(2, "n");
  claim.null.reset();
  const RunRecord run = run_of({measured("a", {1})});
  EXPECT_EQ(verdict(claim, run), Discrimination::unasked);
  claim.exempt = Exemption::oracle;
  EXPECT_EQ(verdict(claim, run), Discrimination::exempt);
  EXPECT_TRUE(is_sound(decided(claim, run)));
}

TEST(Nulls, FurtherVariantsThatPassAreListed) {
  const RunRecord run =
      run_of({measured("a", {1}), measured("b", {1.5}), measured("c", {7}), measured("d", {0}),
              measured("n", {9}), measured("other null", {1}, "null")});
  EXPECT_EQ(decided(at_most(2, "n"), run).passed_too, "b, d, other null");
}

TEST(Nulls, OfAllOthersTheOneThatFailsByLeastIsNearest) {
  const ClaimSpec claim = at_most(2, "n");
  const RunRecord run = run_of({measured("a", {1}), measured("b", {1.5}), measured("c", {2.5}),
                                measured("n", {1e9}), measured("other null", {2.2}, "null")});
  EXPECT_EQ(decided(claim, run).nearest, "other null") << "a null that diverges is no near one";
  EXPECT_EQ(decided(claim, run_of({measured("a", {1}), measured("b", {1})})).nearest, "");
}

RunRecord cases_of_errors(const std::vector<std::pair<double, double>>& own_and_null) {
  RunRecord run;
  for (const auto& [own, null] : own_and_null) {
    const std::string name(1, static_cast<char>('p' + run.cases.size()));
    run.cases.push_back(case_of({measured("a", {own}), measured("n", {null})}, name));
  }
  return run;
}

std::vector<ClaimRecord> all_decided(const ClaimSpec& claim, const RunRecord& run) {
  Experiment experiment;
  experiment.claims = {claim};
  return decide_claims(experiment, run);
}

TEST(ClaimOutcomes, EveryCaseThatHasTheSidesIsDecidedWhateverTheNullSays) {
  RunRecord run = cases_of_errors({{1, 9}, {1, 1}, {5, 9}, {5, 1}, {1, 9}});
  run.cases[4].variants.erase(run.cases[4].variants.begin());
  const auto records = all_decided(at_most(2, "n"), run);
  ASSERT_EQ(records.size(), 4U) << "the last case has no side";
  EXPECT_EQ(outcome_of(records[0]), ClaimOutcome::holds);
  EXPECT_EQ(outcome_of(records[1]), ClaimOutcome::not_told_apart);
  EXPECT_EQ(outcome_of(records[2]), ClaimOutcome::falls_short);
  EXPECT_EQ(outcome_of(records[3]), ClaimOutcome::falls_short);
  EXPECT_TRUE(unsound(records).empty()) << "its null fails it in one case";
  EXPECT_EQ(unsound(all_decided(at_most(2, "n"), cases_of_errors({{1, 1}, {1, 2}}))).size(), 2U);
}

TEST(ClaimOutcomes, ACaseWithoutTheNullIsNotToldApart) {
  RunRecord run = cases_of_errors({{1, 9}, {1, 9}});
  run.cases[1].variants.pop_back();
  EXPECT_EQ(outcome_of(all_decided(at_most(2, "n"), run).at(1)), ClaimOutcome::not_told_apart);
}

TEST(ClaimOutcomes, ACaseWhereASideHasNoValueIsNone) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(all_decided(at_most(2, "n"), cases_of_errors({{1, 9}, {none, 9}})).size(), 1U);
  EXPECT_THROW(all_decided(at_most(2, "n"), cases_of_errors({{none, 9}})), Error);
  RunRecord seeds = cases_of_errors({{1, 9}, {none, 9}});
  for (CaseRecord& in : seeds.cases) in.swept["seed"] = in.name;
  ClaimSpec claim = at_most(2, "n");
  claim.over = ClaimOver::seed;
  EXPECT_THROW(all_decided(claim, seeds), Error) << "a seed is not left out";
}

TEST(ClaimOutcomes, AnExceptedCaseIsDecidedAndShown) {
  ClaimSpec claim = at_most(2, "n");
  claim.except = {{"q", "the load is ten times higher"}};
  const auto records = all_decided(claim, cases_of_errors({{1, 9}, {5, 9}}));
  EXPECT_EQ(records.at(0).excepted, "");
  EXPECT_EQ(records.at(1).excepted, "the load is ten times higher");
  EXPECT_EQ(outcome_of(records[1]), ClaimOutcome::falls_short);
}

TEST(ClaimOutcomes, ACaseIsExceptedWhicheverOfItsSeedsIsNamedAndSpeaks) {
  std::vector<double> own(10, 1);
  own[3] = 5;
  own[4] = 5;
  RunRecord run;
  for (std::size_t i = 0; i < own.size(); ++i) {
    run.cases.push_back(
        case_of({measured("a", {own[i]}), measured("n", {9})}, "seed=" + std::to_string(i)));
    run.cases.back().swept["seed"] = std::to_string(i);
  }
  ClaimSpec claim = at_most(2, "n");
  claim.over = ClaimOver::seed;
  claim.except = {{"seed=0", "too coarse"}};
  const auto records = all_decided(claim, run);
  EXPECT_EQ(outcome_of(records.at(0)), ClaimOutcome::falls_short);
  EXPECT_EQ(records[0].excepted, "too coarse") << "the seed that speaks is another";
}

TEST(ClaimOutcomes, OfSeveralVariantsTheOneNearestToFailingSpeaks) {
  Experiment experiment;
  for (const char* name : {"a", "b", "c"}) {
    ClaimSpec claim = at_most(2, "n");
    claim.variant = name;
    claim.variants = {"a", "b", "c"};
    experiment.claims.push_back(claim);
  }
  const auto of = [&](double c) {
    return decide_claims(experiment, run_of({measured("a", {1}), measured("b", {1.9}),
                                             measured("c", {c}), measured("n", {9})}));
  };
  ASSERT_EQ(of(0).size(), 1U) << "one claim, one decision";
  EXPECT_EQ(of(0)[0].variant, "b");
  EXPECT_EQ(of(0)[0].passed_too, "") << "the others are what it is about";
  EXPECT_EQ(of(3)[0].variant, "c");
  EXPECT_FALSE(of(3)[0].holds);
}

TEST(Nulls, SlackIsValueOverLimit) {
  const RunRecord run = run_of({measured("a", {1}), measured("n", {9})});
  EXPECT_EQ(slack(decided(at_most(4, "n"), run)), 0.25);
  EXPECT_EQ(slack(decided(at_most(0, "n"), run)), std::nullopt);
}

/// Ten seeds of one case: errors of the variant and of the null.
RunRecord values_of_seeds(const std::vector<double>& own, const std::vector<double>& null) {
  RunRecord run;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const std::string seed = std::to_string(i + 1);
    CaseRecord in = case_of({measured("a", {own[i]}), measured("n", {null[i]})},
                            i == 0 ? "default" : "seed=" + seed);
    if (i > 0) in.swept["seed"] = seed;
    run.cases.push_back(in);
  }
  return run;
}

ClaimSpec over_seeds() {
  ClaimSpec claim = at_most(2, "n");
  claim.over = ClaimOver::seed;
  return claim;
}

TEST(SeedClaims, NineOfTenDecide) {
  const std::vector<double> bad(10, 9);
  std::vector<double> own(10, 1);
  own[3] = 5;
  const ClaimRecord record = decided(over_seeds(), values_of_seeds(own, bad));
  EXPECT_TRUE(record.holds);
  EXPECT_EQ(record.case_name, "default");
  EXPECT_EQ(record.left, 5) << "the worst seed speaks";
  EXPECT_THAT(record.detail, HasSubstr("9 of 10 seeds; worst: error of a (max): 5 <= 2 m"));
  EXPECT_EQ(record.null.verdict, Discrimination::discriminates);
  own[4] = 5;
  EXPECT_FALSE(decided(over_seeds(), values_of_seeds(own, bad)).holds);
}

TEST(SeedClaims, CasesForClaimsOnlyDecideNothingByThemselves) {
  RunRecord run = values_of_seeds({1, 1, 1}, {9, 9, 9});
  for (CaseRecord& in : run.cases) in.claims_only = in.name != "default";
  const auto decided_cases = [&](const ClaimSpec& claim) {
    Experiment experiment;
    experiment.quick = true;
    experiment.claims = {claim};
    std::vector<std::string> names;
    for (const ClaimRecord& record : decide_claims(experiment, run)) {
      names.push_back(record.case_name + ": " + record.detail.substr(0, 7));
    }
    return names;
  };
  EXPECT_THAT(decided_cases(at_most(2, "n")), testing::ElementsAre("default: error o"));
  EXPECT_THAT(decided_cases(over_seeds()), testing::ElementsAre("default: 3 of 3 "));
  run.cases[1].swept = {{"scene.width", "2"}};
  EXPECT_THAT(decided_cases(at_most(2, "n")),
              testing::ElementsAre("default: error o", "seed=2: error o"))
      << "cases for claims that are no seeds are decided";
}

TEST(SeedClaims, TheNullFailsInNineOfTen) {
  const std::vector<double> own(10, 1);
  std::vector<double> null(10, 9);
  null[0] = 1;
  EXPECT_EQ(verdict(over_seeds(), values_of_seeds(own, null)), Discrimination::discriminates);
  null[1] = 1;
  EXPECT_EQ(verdict(over_seeds(), values_of_seeds(own, null)), Discrimination::is_void);
}

TEST(SeedClaims, FewerThanTenAreAnErrorOfFullRuns) {
  Experiment experiment;
  experiment.claims = {over_seeds()};
  const RunRecord three = values_of_seeds({1, 1, 1}, {9, 9, 9});
  EXPECT_THROW(decide_claims(experiment, three), Error);
  experiment.quick = true;
  EXPECT_TRUE(decide_claims(experiment, three).at(0).holds);
  experiment.quick = false;
  RunRecord beside = values_of_seeds(std::vector<double>(10, 1), std::vector<double>(10, 9));
  beside.cases.push_back(case_of({measured("a", {3}), measured("n", {9})}, "wide"));
  beside.cases.back().swept["scene.width"] = "2";
  const auto decided = decide_claims(experiment, beside);
  ASSERT_EQ(decided.size(), 2U) << "a case with one seed is decided by it";
  EXPECT_FALSE(decided[1].holds);
  EXPECT_THAT(decided[1].detail, HasSubstr("0 of 1 seed; worst: "));
}

TEST(SeedClaims, ASeedWithoutTheNullLeavesThemUndecided) {
  RunRecord run = values_of_seeds(std::vector<double>(10, 1), std::vector<double>(10, 9));
  run.cases[7].variants.pop_back();
  EXPECT_EQ(verdict(over_seeds(), run), Discrimination::undecided);
}

TEST(SeedClaims, OtherSweepsKeepTheirSeedsApart) {
  RunRecord run = values_of_seeds(std::vector<double>(10, 1), std::vector<double>(10, 9));
  RunRecord finer = values_of_seeds(std::vector<double>(10, 3), std::vector<double>(10, 9));
  for (CaseRecord& in : finer.cases) {
    in.name = "finer," + in.name;
    in.swept["cells"] = "64";
    run.cases.push_back(in);
  }
  Experiment experiment;
  experiment.claims = {over_seeds()};
  const auto records = decide_claims(experiment, run);
  ASSERT_EQ(records.size(), 2U);
  EXPECT_TRUE(records[0].holds);
  EXPECT_FALSE(records[1].holds);
  EXPECT_EQ(records[1].case_name, "finer,default");
}

TEST(StudyNulls, AreTheStudyOfAnotherVariant) {
  RunRecord run;
  for (const double n : {8.0, 16.0, 32.0}) {
    CaseRecord in = case_of({measured("a", {1 / (n * n)}), measured("n", {1 / n})});
    in.name = "n=" + std::to_string(n);
    in.facts["cells"] = n;
    run.cases.push_back(in);
  }
  Experiment experiment;
  StudySpec study;
  study.name = "order";
  study.kind = StudyKind::order;
  study.finer = Finer::larger;
  study.variant = "a";
  study.quantity = "error";
  study.against = "cells";
  experiment.studies = {study};
  ClaimSpec claim;
  claim.text = "second order";
  claim.metric = "study:order";
  claim.is = Comparison::greater_equal;
  claim.value = 1.9;
  claim.null = "n";
  experiment.claims = {claim};
  const ClaimRecord record = decide_claims(experiment, run).at(0);
  EXPECT_TRUE(record.holds);
  EXPECT_NEAR(record.null.left, 1, 1e-12);
  EXPECT_EQ(record.null.verdict, Discrimination::discriminates);
}

}  // namespace
}  // namespace geoprior
