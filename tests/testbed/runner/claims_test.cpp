#include "testbed/runner/judgement/claims.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "testbed/runner/judgement/statistics.h"
#include "testbed/runner/judgement/studies.h"
#include "testbed/runner/options/quantity.h"

namespace geoprior {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A variant with the metric "error" at angles 0, 45, 90.
VariantRecord variant(const std::string& name, std::vector<double> errors) {
  VariantRecord v;
  v.name = name;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    v.frames.push_back({45.0 * static_cast<double>(i), {}});
  }
  v.metrics["error"] = {"m", "", "lower_is_better", std::move(errors)};
  v.summary["whole"] = {7, "J", "", "none"};
  v.timing["solve"] = {{0.3, 0.1, 0.2}, {0.5, 0.4, 0.6}, {0.2, 0.2, 0.2}};
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  v.timing["contact"] = {{kNone, kNone, kNone}, {0.25, kNone, 0.5}, {0.125, 0.125, 0.125}};
  return v;
}

RunRecord record_of(std::vector<VariantRecord> variants) {
  CaseRecord in;
  in.name = "default";
  in.parameter_name = "angle";
  in.parameter_unit = "deg";
  in.seed = 1;
  in.variants = std::move(variants);
  RunRecord record;
  record.cases = {in};
  return record;
}

ClaimSpec claim(const std::string& metric, const std::string& of) {
  ClaimSpec c;
  c.text = "t";
  c.metric = metric;
  c.variant = "a";
  if (!of.empty()) c.of = of;
  return c;
}

ClaimRecord decide(const ClaimSpec& c, const RunRecord& record) {
  Experiment e;
  e.claims = {c};
  const auto decisions = decide_claims(e, record);
  EXPECT_EQ(decisions.size(), 1U);
  return decisions.at(0);
}

const RunRecord kTwo = record_of({variant("a", {1, 5, 2}), variant("b", {4, 10, 20})});

TEST(Claims, ReductionsAndFramesPickTheirValue) {
  const VariantRecord& a = kTwo.cases[0].variants[0];
  const auto value = [&](const char* name, std::optional<double> at, Reduction reduce) {
    return quantity_of(kTwo.cases[0], a, name, at, reduce).value;
  };
  EXPECT_EQ(value("error", {}, Reduction::max), 5);
  EXPECT_EQ(value("error", {}, Reduction::min), 1);
  EXPECT_EQ(value("error", {}, Reduction::median), 2);
  EXPECT_NEAR(value("error", {}, Reduction::mean), 8.0 / 3, 1e-15);
  EXPECT_EQ(value("error", {}, Reduction::last), 2);
  EXPECT_EQ(value("error", {}, Reduction::sum), 8);
  // numpy.quantile([1, 2, 5], 0.95) = 2 + 0.9 (5 - 2)
  EXPECT_NEAR(value("error", {}, Reduction::p95), 4.7, 1e-14);
  EXPECT_NEAR(value("error", {}, Reduction::p99), 4.94, 1e-14);
  EXPECT_NEAR(value("timing:solve", {}, Reduction::p95), 0.47, 1e-14) << "of the frames' medians";
  EXPECT_EQ(value("error", 45, Reduction::max), 5);
  EXPECT_EQ(value("whole", {}, Reduction::max), 7);
  EXPECT_EQ(value("timing:solve", {}, Reduction::median), 0.2) << "median of the frames' medians";
  EXPECT_EQ(value("timing:contact", {}, Reduction::median), 0.25)
      << "what was not entered is left out";
}

TEST(Claims, EveryComparisonFollowsItsDefinition) {
  const auto holds = [](Comparison is, double left_value, double tolerance = 0) {
    ClaimSpec c = claim("error", "");
    c.at_parameter = 0;
    c.value = left_value;
    c.is = is;
    c.tolerance = tolerance;
    return decide(c, kTwo).holds;
  };
  EXPECT_TRUE(holds(Comparison::less_equal, 1));
  EXPECT_FALSE(holds(Comparison::less, 1));
  EXPECT_TRUE(holds(Comparison::less, 1.1));
  EXPECT_TRUE(holds(Comparison::greater_equal, 1));
  EXPECT_FALSE(holds(Comparison::greater, 1));
  EXPECT_FALSE(holds(Comparison::equal, 1.25, 0.2));
  EXPECT_TRUE(holds(Comparison::equal, 1.25, 0.25));
}

TEST(Claims, FactorAndOffsetApplyToTheOtherSide) {
  ClaimSpec c = claim("error", "b");
  c.at_key = "angle_deg";
  c.at_parameter = 90;
  c.factor = 0.05;
  c.offset = 1;
  const ClaimRecord record = decide(c, kTwo);
  EXPECT_EQ(record.left, 2);
  EXPECT_EQ(record.right, 0.05 * 20 + 1);
  EXPECT_TRUE(record.holds);
  EXPECT_THAT(record.detail,
              AllOf(HasSubstr("error of a at angle 90 deg"), HasSubstr("0.05 * 20")));
}

TEST(Claims, OfReduceComparesAVariantWithItselfUnderAnotherReduction) {
  ClaimSpec c = claim("timing:solve", "a");
  c.reduce = Reduction::p95;
  c.of_reduce = Reduction::median;
  c.factor = 2;
  const ClaimRecord record = decide(c, kTwo);
  EXPECT_NEAR(record.left, 0.47, 1e-14);
  EXPECT_NEAR(record.right, 2 * 0.2, 1e-14);
  EXPECT_FALSE(record.holds);
  EXPECT_THAT(record.detail, HasSubstr("timing:solve of a (p95) against a (median)"));
  c.factor = 2.5;
  EXPECT_TRUE(decide(c, kTwo).holds);
}

TEST(Claims, OfAVariantThatFailedFallShort) {
  RunRecord record = kTwo;
  record.cases[0].variants[1].status = "failed";
  record.cases[0].variants[1].error = "does not converge";
  ClaimSpec c = claim("error", "b");
  c.reduce = Reduction::every;
  const ClaimRecord decided = decide(c, record);
  EXPECT_FALSE(decided.holds) << "every frame that b has would hold it";
  EXPECT_THAT(decided.detail, HasSubstr("variant 'b' failed after 3 frames: does not converge"));
  record.cases[0].variants[1].frames.resize(1);
  EXPECT_THAT(decide(c, record).detail, HasSubstr("failed after 1 frame: "));
}

TEST(Claims, EveryFrameMeansTheWorstFrame) {
  ClaimSpec c = claim("error", "b");
  c.reduce = Reduction::every;
  c.factor = 0.5;
  ClaimRecord record = decide(c, kTwo);
  EXPECT_TRUE(record.holds) << "1 <= 2, 5 <= 5, 2 <= 10";
  EXPECT_EQ(record.left, 5);
  c.factor = 0.4;
  record = decide(c, kTwo);
  EXPECT_FALSE(record.holds) << "5 > 4 at 45 degrees, though 2 <= 8 at the largest of b";
  EXPECT_EQ(record.right, 4);
  const double nan = std::nan("");
  c.factor = 0.5;
  EXPECT_EQ(decide(c, record_of({variant("a", {1, nan, 2}), variant("b", {4, 1, nan})})).left, 1);
  EXPECT_THROW(decide(c, record_of({variant("a", {nan}), variant("b", {4})})), Error);
}

/// Forty frames of `a` and `b`, of times about `of_a` and `of_b` milliseconds, spread by a tenth.
ClaimRecord decided_time(double of_a, double of_b, Comparison is = Comparison::less_equal) {
  RunRecord record = record_of({variant("a", {}), variant("b", {})});
  for (VariantRecord& one : record.cases[0].variants) {
    std::vector<std::vector<double>>& solve = one.timing["solve"];
    solve.clear();
    for (int i = 0; i < 40; ++i) {
      one.frames.push_back({double(i), {}});
      const double spread = 1 + 0.1 * std::sin(one.name == "a" ? 1.7 * i : 2.9 * i + 1);
      solve.push_back({1e-3 * spread * (one.name == "a" ? of_a : of_b)});
    }
  }
  ClaimSpec c = claim("timing:solve", "b");
  c.is = is;
  c.reduce = Reduction::median;
  c.exempt = Exemption::timing;
  return decide(c, record);
}

TEST(Claims, ATimeIsDecidedWhereItsIntervalExcludesEquality) {
  EXPECT_EQ(outcome_of(decided_time(1, 2)), ClaimOutcome::holds);
  EXPECT_EQ(outcome_of(decided_time(2, 1)), ClaimOutcome::falls_short);
  EXPECT_EQ(outcome_of(decided_time(2, 1, Comparison::greater)), ClaimOutcome::holds);
  for (const double near : {0.995, 1.005}) {
    const ClaimRecord record = decided_time(near, 1);
    EXPECT_EQ(outcome_of(record), ClaimOutcome::not_told_apart) << near;
    EXPECT_THAT(record.null.detail, HasSubstr("95 % interval ["));
  }
}

TEST(Claims, ASingleTimeIsUndecided) {
  ClaimSpec c = claim("timing:prepare", "b");
  c.exempt = Exemption::timing;
  RunRecord record = kTwo;
  for (VariantRecord& one : record.cases[0].variants) {
    one.timing["prepare"] = {{one.name == "a" ? 1.0 : 9.0}};
  }
  EXPECT_EQ(outcome_of(decide(c, record)), ClaimOutcome::not_told_apart);
  EXPECT_THAT(decide(c, record).null.detail, HasSubstr("a single time, which has no interval"));
  for (VariantRecord& one : record.cases[0].variants) {
    one.timing["prepare"] = {std::vector<double>(5, one.name == "a" ? 1.0 : 9.0)};
  }
  EXPECT_EQ(outcome_of(decide(c, record)), ClaimOutcome::holds) << "five repetitions";
}

TEST(Claims, WhatTheRunDoesNotHaveIsAnErrorAndDoesNotHold) {
  EXPECT_THROW(decide(claim("eror", "b"), kTwo), Error);
  EXPECT_THROW(decide(claim("error", "c"), kTwo), Error);
  EXPECT_THROW(decide(claim("timing:prepare", "b"), kTwo), Error);
  ClaimSpec at = claim("error", "b");
  at.at_parameter = 60;
  EXPECT_THROW(decide(at, kTwo), Error);
  at.at_parameter = 90;
  at.at_key = "angle_rad";
  EXPECT_THROW(decide(at, kTwo), Error);
  const double nan = std::nan("");
  ClaimSpec none = claim("error", "");
  none.value = 1;
  EXPECT_THROW(decide(none, record_of({variant("a", {nan, nan})})), Error);
}

/// Cases with fact "vertices" = n and error y(n).
template <class Y>
RunRecord family(const std::vector<double>& n, Y y) {
  RunRecord record;
  for (const double x : n) {
    CaseRecord in = record_of({variant("a", {y(x)})}).cases[0];
    in.name = "n=" + std::to_string(x);
    in.facts["vertices"] = x;
    in.swept["scene.n"] = std::to_string(x);
    record.cases.push_back(in);
  }
  return record;
}

StudySpec study(StudyKind kind, const std::string& against) {
  StudySpec s;
  s.name = "s";
  s.kind = kind;
  s.variant = "a";
  s.quantity = "error";
  s.against = against;
  return s;
}

StudyRecord make(const StudySpec& s, const RunRecord& record) {
  Experiment e;
  e.studies = {s};
  return make_studies(e, record).at(0);
}

TEST(Studies, ExponentOfAPowerLawIsExactWithAnIntervalOfRoundOff) {
  const RunRecord record = family({10, 20, 40, 80}, [](double n) { return 3 * std::pow(n, 1.1); });
  const StudyRecord s = make(study(StudyKind::exponent, "vertices"), record);
  EXPECT_NEAR(s.value, 1.1, 1e-12);
  EXPECT_NEAR(s.high - s.low, 0, 1e-12);
  EXPECT_EQ(s.x.size(), 4U);
}

TEST(Studies, OrderIsPositiveForStepsAndForCounts) {
  const RunRecord by_step = family({0.1, 0.05, 0.025}, [](double h) { return h * h; });
  EXPECT_NEAR(make(study(StudyKind::order, "scene.n"), by_step).value, 2, 1e-12);
  const RunRecord by_count = family({8, 16, 32}, [](double n) { return 5 / (n * n); });
  StudySpec s = study(StudyKind::order, "vertices");
  s.finer = Finer::larger;
  EXPECT_NEAR(make(s, by_count).value, 2, 1e-12);
}

TEST(Studies, ClaimsDecideThem) {
  Experiment e;
  e.studies = {study(StudyKind::exponent, "vertices")};
  ClaimSpec c = claim("study:s", "");
  c.value = 1.1;
  e.claims = {c};
  const auto power = [](double p) { return [p](double n) { return std::pow(n, p); }; };
  EXPECT_TRUE(decide_claims(e, family({1, 2, 4}, power(1.0)))[0].holds);
  EXPECT_FALSE(decide_claims(e, family({1, 2, 4}, power(1.2)))[0].holds);
}

TEST(Studies, TooFewCasesAndValuesWithoutLogarithmAreErrors) {
  const auto zero = [](double) { return 0.0; };
  EXPECT_THROW(make(study(StudyKind::exponent, "vertices"), family({1, 2}, zero)), Error);
  EXPECT_THROW(make(study(StudyKind::exponent, "faces"), family({1, 2}, zero)), Error);
  EXPECT_THROW(
      make(study(StudyKind::exponent, "vertices"), family({1}, [](double n) { return n; })), Error);
}

TEST(Studies, SpreadIsTheStandardDeviationWithAReproducibleInterval) {
  const RunRecord record = family({2, 4, 4, 4, 5, 5, 7, 9}, [](double n) { return n; });
  const StudyRecord s = make(study(StudyKind::spread, ""), record);
  EXPECT_NEAR(s.value, std::sqrt(32.0 / 7), 1e-14) << "sum of squares about the mean 5 is 32";
  EXPECT_LT(s.low, s.value);
  EXPECT_GT(s.high, s.value);
  EXPECT_EQ(make(study(StudyKind::spread, ""), record).low, s.low);
}

/// Cases with events of these energies, each a second after the one before.
RunRecord sheets(const std::vector<std::vector<double>>& energies) {
  RunRecord record;
  for (const std::vector<double>& of_sheet : energies) {
    CaseRecord in = record_of({variant("a", {0})}).cases[0];
    in.name = "sheet " + std::to_string(record.cases.size());
    double time = 0;
    for (const double energy : of_sheet) {
      Event event;
      event.time_s = time++;
      event.energy_J = energy;
      in.variants[0].events.push_back(event);
    }
    record.cases.push_back(in);
  }
  return record;
}

/// Mean energy; absent of fewer than three events.
StudySpec pooled_mean() {
  StudySpec s = study(StudyKind::pooled, "");
  s.of_events = [](const std::vector<Event>& events) -> std::optional<double> {
    if (events.size() < 3) return std::nullopt;
    double sum = 0;
    for (const Event& event : events) sum += event.energy_J;
    return sum / static_cast<double>(events.size());
  };
  return s;
}

TEST(Studies, PooledEventsHaveTheJackknifesInterval) {
  const StudyRecord s = make(pooled_mean(), sheets({{1}, {2}, {3}, {4}, {10}}));
  EXPECT_NEAR(s.value, 4, 1e-14);
  EXPECT_EQ(s.y, (std::vector<double>{19 / 4.0, 18 / 4.0, 17 / 4.0, 16 / 4.0, 10 / 4.0}));
  // Of a mean the jackknife's error is the standard error: squares about it are 50.
  EXPECT_NEAR(s.high - s.value, student_t(0.95, 4) * std::sqrt(50.0 / 4 / 5), 1e-12);
  EXPECT_NEAR(s.value - s.low, s.high - s.value, 1e-12);
}

TEST(Studies, PooledEventsWithoutAValueHaveNoneOrNoInterval) {
  EXPECT_TRUE(std::isnan(make(pooled_mean(), sheets({{1}, {2}})).value));
  const StudyRecord s = make(pooled_mean(), sheets({{1}, {2}, {3}}));
  EXPECT_EQ(s.value, 2);
  EXPECT_TRUE(std::isnan(s.low)) << "two events are too few";
}

TEST(Studies, PooledEventsAreInTimeOneCaseAfterAnother) {
  StudySpec s = study(StudyKind::pooled, "");
  std::vector<double> times;
  s.of_events = [&](const std::vector<Event>& events) -> std::optional<double> {
    times.clear();
    for (const Event& event : events) times.push_back(event.time_s);
    return 0;
  };
  make(s, sheets({{1, 1}, {1, 1, 1}}));
  EXPECT_EQ(times, (std::vector<double>{0, 1, 1, 2, 3}));
}

/// Cases of two variants with these errors.
RunRecord seeds(const std::vector<double>& a, const std::vector<double>& b) {
  RunRecord record;
  for (std::size_t i = 0; i < a.size(); ++i) {
    CaseRecord in = record_of({variant("a", {a[i]}), variant("b", {b[i]})}).cases[0];
    in.name = "seed=" + std::to_string(i);
    record.cases.push_back(in);
  }
  return record;
}

StudySpec within_spread() {
  StudySpec s = study(StudyKind::within_spread, "");
  s.of = "b";
  return s;
}

TEST(Studies, WithinSpreadIsTheDistanceOfTheMediansOverHalfTheRange) {
  // Medians 5 and 3, range 1 … 5.
  const RunRecord record = seeds({4, 5, 9}, {1, 5, 3});
  const StudyRecord s = make(within_spread(), record);
  EXPECT_EQ(s.value, 2.0 / 2);
  EXPECT_LE(s.low, s.value);
  EXPECT_GE(s.high, s.value);
  // No resample's median leaves 4 … 9 or 1 … 5.
  EXPECT_LE(s.high, (9.0 - 1.0) / 2);
  EXPECT_EQ(s.y, (std::vector<double>{4, 5, 9}));
  EXPECT_EQ(s.y_of, (std::vector<double>{1, 5, 3}));
  EXPECT_EQ(make(within_spread(), record).high, s.high);
}

TEST(Studies, WithinSpreadOfAYardstickWithoutSpreadIsZeroOrInfinite) {
  EXPECT_EQ(make(within_spread(), seeds({2, 2, 2}, {2, 2, 2})).value, 0);
  const StudyRecord apart = make(within_spread(), seeds({3, 3, 3}, {2, 2, 2}));
  EXPECT_TRUE(std::isinf(apart.value));
  EXPECT_TRUE(std::isinf(apart.low));
}

TEST(Studies, RangeIsTheLargestCaseOverTheSmallest) {
  const StudyRecord s = make(study(StudyKind::range, ""), seeds({4, 5, 8}, {1, 1, 1}));
  EXPECT_EQ(s.value, 2);
  EXPECT_TRUE(std::isnan(s.low));
  EXPECT_THROW(make(study(StudyKind::range, ""), seeds({4, 0}, {1, 1})), Error);
}

TEST(Studies, RangeOfTimesHasTheIntervalOfTheirFrames) {
  RunRecord record = seeds({1, 1}, {1, 1});
  for (CaseRecord& in : record.cases) in.variants[0].frames = {{0, {}}, {45, {}}, {90, {}}};
  record.cases[1].variants[0].timing["solve"] = {{0.4}, {1}, {0.4}};
  StudySpec s = study(StudyKind::range, "");
  s.quantity = "timing:solve";
  s.reduce = Reduction::mean;
  const StudyRecord made = make(s, record);  // 0.2, 0.5, 0.2 s in the other case
  EXPECT_NEAR(made.value, 2, 1e-12);
  EXPECT_GE(made.low, 1);
  EXPECT_LT(made.low, 2);
  EXPECT_GT(made.high, 2);
  EXPECT_LE(made.high, 5);
}

// Cost and quality are one metric here: the study takes its numbers from the records.
TEST(Studies, MatchedComparesWithTheCheapestFamily) {
  StudySpec s = study(StudyKind::matched, "");
  s.match = s.quantity;
  s.match_reduce = s.reduce;
  s.families = {{"b"}};
  const StudyRecord made = make(s, seeds({4, 4, 4}, {2, 2, 2}));
  EXPECT_EQ(made.value, 0.5);
  EXPECT_EQ(made.x, (std::vector<double>{4, 2}));
  EXPECT_EQ(made.y, (std::vector<double>{4, 2}));
  s.of = "b";
  EXPECT_EQ(make(s, seeds({4, 4, 4}, {2, 2, 2})).x, (std::vector<double>{2, 0}));
  s.families = {{"nobody"}};
  EXPECT_THROW(make(s, seeds({4}, {2})), Error);
}

// Of one case there are the times of its frames: 0.2, 0.5 and 0.2 s, and twice as much of the
// rival, whose third frame was as fast as the method's.
TEST(Studies, MatchedDrawsTheFramesOfASingleCase) {
  RunRecord record = kTwo;
  record.cases[0].variants[1].timing["solve"] = {{0.4}, {1}, {0.2}};
  StudySpec s = study(StudyKind::matched, "");
  s.quantity = "timing:solve";
  s.match = "error";
  s.families = {{"a", "b"}};
  s.variant = "b";
  const StudyRecord made = make(s, record);
  EXPECT_EQ(made.value, 0.5) << "the coarsest errs less";
  EXPECT_EQ(made.x, (std::vector<double>{20, 2, 20}));
  EXPECT_EQ(made.y, (std::vector<double>{0.4, 0.2, 0.4}));
  EXPECT_EQ(made.low, 0.5);
  EXPECT_EQ(made.high, 1);
  // Frames that cost most count in the mean.
  s.reduce = Reduction::mean;
  EXPECT_EQ(make(s, record).value, 0.3 / (1.6 / 3));
  record.cases[0].variants[0].metrics["error"].values = {-1, -1, -1};
  EXPECT_THROW(make(s, record), Error) << "an error is not negative";
}

TEST(Studies, LeaveOutVariantsThatFailed) {
  RunRecord record = seeds({4, 5, 9, 1000}, {1, 5, 3, 3});
  record.cases[3].variants[0].status = "failed";
  const StudyRecord s = make(within_spread(), record);
  EXPECT_EQ(s.value, 1);
  EXPECT_EQ(s.y.size(), 3U);
}

// Two samples of ten from one distribution: their medians agree within half the range of one almost
// always, and the interval of the ratio holds the truth 0 for none, as a distance is positive; what
// the test can see is that a shift of five standard deviations is never within.
TEST(Statistics, MedianDistanceTellsAShiftFromNone) {
  RandomStream random(7, "samples");
  int same_within = 0, shifted_within = 0;
  for (int t = 0; t < 200; ++t) {
    std::vector<double> a, b, shifted;
    for (int i = 0; i < 10; ++i) {
      a.push_back(random.normal());
      b.push_back(random.normal());
      shifted.push_back(a.back() + 5);
    }
    const auto ratio = [&](const std::vector<double>& x) {
      return median_distance_with_interval(x, b, RandomStream(1, "r")).value;
    };
    same_within += ratio(a) <= 1 ? 1 : 0;
    shifted_within += ratio(shifted) <= 1 ? 1 : 0;
  }
  EXPECT_GE(same_within, 198);
  EXPECT_EQ(shifted_within, 0);
}

TEST(Statistics, StudentQuantilesAreThoseOfTheTables) {
  // Abramowitz and Stegun, table 26.10, two-sided 95 %.
  EXPECT_NEAR(student_t(0.95, 1), 12.706, 5e-4);
  EXPECT_NEAR(student_t(0.95, 2), 4.303, 5e-4);
  EXPECT_NEAR(student_t(0.95, 3), 3.182, 5e-4);
  EXPECT_NEAR(student_t(0.95, 4), 2.776, 5e-4);
  EXPECT_NEAR(student_t(0.95, 10), 2.228, 5e-4);
  EXPECT_NEAR(student_t(0.95, 120), 1.980, 5e-4);
}

TEST(Statistics, SlopeIntervalCoversTheTruthAboutAsOftenAsItSays) {
  RandomStream random(3, "coverage");
  const std::vector<double> x{0, 1, 2, 3, 4};
  int covered = 0;
  constexpr int kTrials = 2000;
  for (int t = 0; t < kTrials; ++t) {
    std::vector<double> y;
    for (const double xi : x) y.push_back(2 * xi + random.normal());
    const Interval slope = slope_with_interval(x, y);
    covered += slope.low <= 2 && 2 <= slope.high ? 1 : 0;
  }
  // Binomial(2000, 0.95): standard deviation 9.7; four of them.
  EXPECT_NEAR(covered, 0.95 * kTrials, 40);
}

TEST(Statistics, TwoPointsFixASlopeWithoutAnInterval) {
  const Interval slope = slope_with_interval(std::vector<double>{0, 1}, std::vector<double>{0, 3});
  EXPECT_EQ(slope.value, 3);
  EXPECT_TRUE(std::isnan(slope.low));
}

}  // namespace
}  // namespace geoprior
