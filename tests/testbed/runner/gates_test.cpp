#include "testbed/runner/reference/gates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "testbed/runner/reference/headlines.h"
#include "testbed/runner/reference/reference.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/runner/headline_references.h"

namespace geoprior {
namespace {

using testing::HasSubstr;

MetricEntry metric(const std::string& name, Direction direction, Tolerance tolerance) {
  MetricEntry entry;
  entry.name = name;
  entry.unit = "m";
  entry.direction = direction;
  entry.tolerance = tolerance;
  return entry;
}

/// Metrics of every direction whose own tolerance, a quarter, is wide.
Topic wide_topic() {
  Topic topic;
  topic.metrics.emplace_back().rows = {metric("error", Direction::lower_is_better, {0.01, 0.25}),
                                       metric("score", Direction::higher_is_better, {0.01, 0.25}),
                                       metric("ratio", Direction::closer_to_target, {0.01, 0.25}),
                                       metric("length", Direction::none, {0.01, 0.25})};
  topic.metrics[0].rows[2].target = 1;
  topic.diagnostics = {{"iterations", "1", "steps", true, {0.5, 0}},
                       {"residual", "1", "what is left"}};
  return topic;
}

ClaimSpec claim_about(const std::string& name) {
  ClaimSpec claim;
  claim.text = "about " + name;
  claim.metric = name;
  claim.variant = "v";
  claim.value = 1;
  return claim;
}

StudySpec study_of_error(const std::string& name, StudyKind kind) {
  StudySpec study;
  study.name = name;
  study.kind = kind;
  study.variant = "v";
  study.quantity = "error";
  return study;
}

CaseRecord case_of(const std::string& name, double error, std::vector<double> iterations) {
  VariantRecord variant;
  variant.name = "v";
  variant.frames = {{0, {}}, {1, {}}};
  variant.metrics["error"] = {"m", "", "lower_is_better", {error / 2, error}};
  variant.diagnostics["iterations"] = {"1", "", std::move(iterations)};
  variant.diagnostics["residual"] = {"1", "", {0.1}};
  CaseRecord in;
  in.name = name;
  in.variants = {variant};
  return in;
}

ReferenceSet blessed(const GatedValues& values, const Gates& gates) {
  return bless_values(values, gates);
}

TEST(Gates, HeadlineMetricsMayWorsenByThreePercentWhateverTheirTolerance) {
  const Topic topic = wide_topic();
  Experiment experiment;
  for (const MetricEntry& entry : metric_rows(topic))
    experiment.claims.push_back(claim_about(entry.name));
  const Gates gates(experiment, topic);
  for (const MetricEntry& entry : metric_rows(topic)) {
    const std::string name = entry.name + ".max";
    const auto at = [&](const std::string& variant, double value) {
      const ReferenceSet set = blessed({{"default", {{variant, {{name, {2, "m"}}}}}}}, gates);
      return compare_with_reference({{"default", {{variant, {{name, {value, "m"}}}}}}}, set, gates);
    };
    const double worse = test::worsened(gates.of("v", name), 2);
    ASSERT_EQ(at("v", worse).size(), 1U) << name << " at " << worse;
    EXPECT_TRUE(at("v", worse)[0].fails);
    EXPECT_NEAR(at("v", worse)[0].tolerance, 0.06, 1e-12) << "3 % of 2, which is over 2 * 0.01";
    EXPECT_EQ(at("v", 2 + 0.98 * (worse - 2)).size(), 0U) << name;
    EXPECT_EQ(at("another", worse).size(), 0U) << "no claim is about that variant";
    if (entry.direction == Direction::none) continue;
    EXPECT_EQ(at("v", 2 - 5 * (worse - 2)).size(), 0U) << "better within the tolerance";
  }
  EXPECT_EQ(headline_limit(gates.of("v", "error.max"), 0.1), 0.02) << "twice the absolute one";
}

TEST(Gates, OfCountedWorkOnlyMoreFails) {
  const Topic topic = wide_topic();
  const Experiment experiment;
  const Gates gates(experiment, topic);
  const auto values = [&](std::vector<double> iterations) {
    RunRecord record;
    record.cases = {case_of("default", 1, std::move(iterations))};
    return gated_values(experiment, topic, record, {});
  };
  const GatedValues before = values({3, std::nan(""), 5});
  EXPECT_EQ(before.at("default").at("v").at("diagnostic:iterations").value, 4) << "mean";
  EXPECT_FALSE(before.at("default").at("v").contains("diagnostic:residual")) << "no work";
  const ReferenceSet set = blessed(before, gates);
  EXPECT_TRUE(compare_with_reference(values({4.5}), set, gates).empty());
  const auto more = compare_with_reference(values({4.6}), set, gates);
  ASSERT_EQ(more.size(), 1U);
  EXPECT_TRUE(more[0].fails);
  EXPECT_EQ(more[0].metric, "diagnostic:iterations");
  const auto less = compare_with_reference(values({1}), set, gates);
  ASSERT_EQ(less.size(), 1U);
  EXPECT_FALSE(less[0].fails);
  EXPECT_THAT(mismatch_text("id", less[0]), HasSubstr("less work (bless it"));
}

TEST(Gates, AKnownShortfallMayNeitherGrowNorShrinkUnseen) {
  Topic topic = wide_topic();
  topic.metrics[0].rows[0].tolerance = {0.1, 0};
  Experiment experiment;
  experiment.claims = {claim_about("error")};
  experiment.claims[0].known_shortfall = "too coarse";
  const Gates gates(experiment, topic);
  const auto values = [&](double left) {
    RunRecord record;
    record.cases = {case_of("default", 0, {1})};
    ClaimRecord decided{"about error", "default", "", left, 1, left <= 1};
    return gated_values(experiment, topic, record, {decided});
  };
  const ReferenceSet set = blessed(values(1.5), gates);
  EXPECT_EQ(set.at("default").at("").at("shortfall:about error").value, 0.5);
  EXPECT_TRUE(compare_with_reference(values(1.55), set, gates).empty());
  const auto only = [&](double left) {
    const auto found = compare_with_reference(values(left), set, gates);
    EXPECT_EQ(found.size(), 1U) << left;
    EXPECT_TRUE(found.at(0).fails) << left;
    return found.at(0).problem;
  };
  EXPECT_EQ(only(1.7), "changed for the worse");
  EXPECT_THAT(only(1.2), HasSubstr("for the better (bless it"));
  EXPECT_THAT(only(0.9), HasSubstr("remove its known_shortfall"));
  // A relative tolerance is a share of what the claim compares, not of the difference.
  topic.metrics[0].rows[0].tolerance = {0, 0.1};
  EXPECT_TRUE(compare_with_reference(values(1.64), set, Gates(experiment, topic)).empty());
  EXPECT_EQ(compare_with_reference(values(1.68), set, Gates(experiment, topic)).size(), 1U);
}

TEST(Gates, StudiesHaveATolerance) {
  const Topic topic = wide_topic();
  Experiment experiment;
  experiment.studies = {study_of_error("rate", StudyKind::order),
                        study_of_error("scatter", StudyKind::spread)};
  experiment.claims = {claim_about("study:rate")};
  experiment.claims[0].is = Comparison::greater_equal;
  RunRecord record;
  record.studies = {{"rate", "order", "error", 2.0, 1.9, 2.1, {}, {}, {}},
                    {"scatter", "spread", "error", 0.5, 0.4, 0.6, {}, {}, {}}};
  const GatedValues values = gated_values(experiment, topic, record, {});
  EXPECT_EQ(values.at("").at("").at("study:rate").unit, "1");
  EXPECT_EQ(values.at("").at("").at("study:scatter").unit, "m");
  const Gates gates(experiment, topic);
  EXPECT_EQ(gates.of("", "study:rate").tolerance.absolute, 0.02);
  EXPECT_EQ(gates.of("", "study:rate").direction, Direction::higher_is_better);
  EXPECT_TRUE(gates.of("", "study:rate").headline);
  EXPECT_EQ(gates.of("", "study:scatter").tolerance.relative, 0.25) << "that of its quantity";
  EXPECT_TRUE(gates.of("v", "error.max").headline) << "the claim is about the study of it";
  experiment.tolerances["study:rate"] = {0.5, 0};
  EXPECT_EQ(Gates(experiment, topic).of("", "study:rate").tolerance.absolute, 0.5);
}

TEST(Gates, WhatTheTableLeavesUngatedIsNotCompared) {
  Topic topic = wide_topic();
  const Experiment experiment;
  const ReferenceSet set =
      blessed({{"default", {{"v", {{"error.max", {1, "m"}}}}}}}, Gates(experiment, topic));
  topic.metrics[0].rows[0].ungated = "its values are times";
  const Gates gates(experiment, topic);
  const GatedValues now{{"default", {{"v", {{"error.max", {9, "m"}}}}}}};
  EXPECT_TRUE(compare_with_reference(now, set, gates).empty());
  EXPECT_TRUE(compare_with_reference({}, set, gates).empty()) << "nor missed";
  EXPECT_TRUE(blessed(now, gates).empty()) << "nor blessed";
}

TEST(Gates, AMethodWhoseResultsDoNotRepeatIsNotCompared) {
  Topic topic = wide_topic();
  topic.methods.emplace_back().name = "drifting";
  RunRecord record;
  record.cases = {case_of("default", 1, {2})};
  record.cases[0].variants[0].method = "drifting";
  Experiment experiment;
  experiment.claims = {claim_about("error")};
  EXPECT_FALSE(gated_values(experiment, topic, record, {}).at("default").at("v").empty());
  topic.methods[0].ungated = "a library's generator";
  EXPECT_FALSE(gated_values(experiment, topic, record, {}).contains("default"));
}

TEST(Gates, WhatBifurcatesIsComparedByItsMedianOverTheSeeds) {
  const Topic topic = wide_topic();
  Experiment experiment;
  experiment.claims = {claim_about("error")};
  experiment.bifurcates = true;
  RunRecord record;
  const std::vector<double> errors{9, 1, 3};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    CaseRecord in = case_of("seed=" + std::to_string(i), errors[i], {errors[i]});
    in.swept = {{"seed", std::to_string(i)}};
    record.cases.push_back(in);
  }
  const GatedValues values = gated_values(experiment, topic, record, {});
  ASSERT_EQ(values.size(), 1U);
  EXPECT_EQ(values.at("seed=*").at("v").at("error.max").value, 3);
  EXPECT_EQ(values.at("seed=*").at("v").at("diagnostic:iterations").value, 3);
}

TEST(Gates, CasesForClaimsOnlyHaveNoReferenceValues) {
  RunRecord record;
  record.cases = {case_of("default", 1, {1}), case_of("seed=2", 2, {2})};
  record.cases[1].claims_only = true;
  const GatedValues values = gated_values(Experiment(), wide_topic(), record, {});
  EXPECT_TRUE(values.contains("default"));
  EXPECT_FALSE(values.contains("seed=2"));
}

// What a claim reads is held as the claim reads it; what a figure plots or [check] names, at its
// worst.
TEST(Headlines, AreWhatClaimsReadFiguresShowAndCheckNames) {
  Topic topic = wide_topic();
  MetricGroup& sequence = topic.metrics.emplace_back();
  sequence.rows = {metric("pop", Direction::lower_is_better, {})};
  sequence.of_sequence = [](const Scene&, const FrameSequence&) { return MetricValues{}; };
  topic.metrics.emplace_back().rows = {metric("untold", Direction::closer_to_target, {}),
                                       metric("unread", Direction::none, {})};
  Experiment experiment;
  const auto claim = [&](const std::string& name, Reduction reduce) -> ClaimSpec& {
    experiment.claims.push_back(claim_about(name));
    experiment.claims.back().reduce = reduce;
    return experiment.claims.back();
  };
  claim("error", Reduction::p95);
  claim("error", Reduction::max).at_parameter = 90;
  claim("score", Reduction::every).is = Comparison::greater_equal;
  claim("pop", Reduction::max);
  claim("timing:solve", Reduction::median);
  claim("ratio", Reduction::last).of_reduce = Reduction::min;
  experiment.view.metrics = {"error", "length", "timing:solve"};
  experiment.checked_metrics = {"length", "untold"};
  std::vector<std::string> names;
  for (const Headline& headline : headlines(experiment, topic)) names.push_back(headline.name());
  EXPECT_THAT(names, testing::ElementsAre("error.p95", "error@90", "score.min", "pop", "ratio.last",
                                          "ratio.min", "length.max", "untold.min", "untold.max"));
}

TEST(Headlines, AreOneNumberEach) {
  const CaseRecord in = case_of("default", 4, {1});
  const VariantRecord& variant = in.variants[0];
  const auto value = [&](const Headline& headline) {
    return headline_value(in, variant, headline).value();
  };
  EXPECT_EQ(value({"error", false, std::nullopt, Reduction::max}), 4);
  EXPECT_EQ(value({"error", false, std::nullopt, Reduction::mean}), 3);
  EXPECT_EQ(value({"error", false, 0.0, Reduction::max}), 2);
  EXPECT_TRUE(std::isnan(value({"error", false, 0.5, Reduction::max}))) << "no such frame";
  EXPECT_FALSE(headline_value(in, variant, {"score", false, std::nullopt, Reduction::max}));
  EXPECT_FALSE(headline_value(in, variant, {"pop", true, std::nullopt, Reduction::max}));
  EXPECT_EQ(without_statistic("error@0.5"), "error");
  EXPECT_EQ(without_statistic("error.max"), "error");
  EXPECT_EQ(without_statistic("pop"), "pop");
  EXPECT_EQ(without_statistic("shortfall:3.5 m"), "shortfall:3.5 m");
}

class Bifurcating : public test::RunTest {};

TEST_F(Bifurcating, NeedsASweepOverTheSeed) {
  const std::string head =
      "title = \"Seeds\"\ntopic = \"toy-circle\"\n[scene]\n[[variant]]\nname = \"exact\"\n"
      "method = \"exact\"\n[check]\nbifurcates = true\n";
  const auto without = write_experiment("toy-circle/one", head);
  EXPECT_THAT(test::error_of([&] { (void)load(without); }),
              testing::AllOf(HasSubstr("one.toml:8"), HasSubstr("no seeds")));
  const std::string sweep = "[[sweep]]\nkey = \"seed\"\nvalues = [1, 2]\nbase = false\n";
  const Experiment loaded = load(write_experiment("toy-circle/two", head + sweep));
  EXPECT_TRUE(loaded.bifurcates);
  EXPECT_THAT(loaded.resolved_toml, HasSubstr("bifurcates = true"));
  const Experiment other = load(write_experiment("toy-circle/two",
                                                 "title = \"Seeds\"\ntopic = \"toy-circle\"\n"
                                                 "[scene]\n[[variant]]\nname = \"exact\"\n"
                                                 "method = \"exact\"\n" +
                                                     sweep));
  EXPECT_EQ(loaded.hash, other.hash) << "how a run is compared changes no number of it";
}

}  // namespace
}  // namespace geoprior
