// Graded mutations: how much of its method a claim needs.
#include "testbed/runner/judgement/grades.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/runner/judgement/blended_frame.h"
#include "testbed/runner/judgement/claims.h"
#include "testbed/runner/opened_run.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

Part triangle(double size) {
  Part part;
  part.points.resize(3, 3);
  part.points << 0, 0, 0, size, 0, 0, 0, size, 0;
  part.triangles.resize(1, 3);
  part.triangles << 0, 1, 2;
  part.arrays = {{"height", "m", NamedArray::On::points, Eigen::Vector3d::Constant(size)}};
  part.arrays.push_back({"kind", "1", NamedArray::On::cells, Eigen::VectorXd::Constant(1, size)});
  part.arrays.back().names = {"none", "one", "two", "three", "four"};
  return part;
}

TEST(BlendedFrame, MovesPointsNumbersAndTablesThatCorrespond) {
  Frame input, output;
  input.parts["surface"] = triangle(1);
  output.parts["surface"] = triangle(3);
  input.tables["steps"] = {{"n"}, Eigen::MatrixXd::Constant(1, 1, 10)};
  output.tables["steps"] = {{"n"}, Eigen::MatrixXd::Constant(1, 1, 20)};
  const Frame half = blended_frame(input, output, 0.5);
  EXPECT_EQ(half.require_part("surface").points(1, 0), 2);
  EXPECT_EQ(half.require_array("surface", "height", NamedArray::On::points).values(2, 0), 2);
  EXPECT_EQ(half.require_array("surface", "kind", NamedArray::On::cells).values(0, 0), 3)
      << "codes are not mixed";
  EXPECT_EQ(half.require_table("steps").rows(0, 0), 15);
  EXPECT_EQ(blended_frame(input, output, 0).require_part("surface").points,
            input.require_part("surface").points);
}

TEST(BlendedFrame, LeavesWhatTheInputHasNotOrInAnotherTopology) {
  Frame input, output;
  input.parts["surface"] = triangle(1);
  input.parts["surface"].triangles << 0, 2, 1;
  output.parts["surface"] = triangle(3);
  output.parts["rulings"] = triangle(3);
  output.tables["steps"] = {{"n"}, Eigen::MatrixXd::Constant(1, 1, 20)};
  input.tables["steps"] = {{"n"}, Eigen::MatrixXd::Constant(2, 1, 10)};
  const Frame blended = blended_frame(input, output, 0);
  EXPECT_EQ(blended.require_part("surface").points, output.require_part("surface").points);
  EXPECT_EQ(blended.require_part("rulings").points, output.require_part("rulings").points);
  EXPECT_EQ(blended.require_table("steps").rows(0, 0), 20);
}

/// A disc whose points are all at 1.1 radii, and one at 0.8 radii as the input.
class Grades : public RunTest {
 protected:
  Experiment discs(const std::string& claims, const std::string& input = "small") {
    return load(write_experiment("toy-circle/discs", "input = \"" + input + R"("
title = "discs"
topic = "toy-circle"
[scene]
points = 24
motion = { from_deg = 0, to_deg = 90, frames = 4 }
[[variant]]
name = "exact"
method = "exact"
[[variant]]
name = "small"
method = "polygon"
options = { segments = 24, scale = 0.8 }
[[variant]]
name = "large"
method = "polygon"
reference = "exact"
options = { segments = 24, scale = 1.1 }
)" + claims));
  }
  static std::string claim(const std::string& metric, const std::string& rest) {
    std::string text = metric + ", " + rest.substr(0, rest.find('\n'));
    std::replace(text.begin(), text.end(), '"', '\'');
    return "[[claim]]\ntext = \"" + text + "\"\nmetric = \"" + metric +
           "\"\nvariant = \"large\"\nnull = \"small\"\n" + rest;
  }
  std::vector<ClaimRecord> graded(const Experiment& experiment) {
    ExecuteResult result = run(experiment, folder() / std::to_string(++runs_));
    grade_claims(experiment, toy::topics(), result.folder, result.record);
    return result.record.claims;
  }

 private:
  int runs_ = 0;
};

// Points at 0.8 + 0.3 s: their error |0.3 s - 0.2| is at most 0.12 from s = 0.267 on, and the mixed
// values 0.2 - 0.1 s from s = 0.8 on. Of frames, 0.3 is the first step.
TEST_F(Grades, AreLookedForInFramesWhereTheMetricFollowsThem) {
  const Experiment experiment = discs(
      claim("radius_error", "value = 0.12\n") + claim("largest_radius_error", "value = 0.12\n") +
      claim("radius_error", "at = { angle_deg = 30 }\nvalue = 0.12\n") +
      claim("radius_error", "reduce = \"every\"\nvalue = 0.12\n"));
  for (const ClaimRecord& one : graded(experiment)) {
    EXPECT_EQ(one.grade.of, Graded::frames) << one.text;
    EXPECT_DOUBLE_EQ(one.grade.least, 0.3) << one.text;
    EXPECT_EQ(one.grade.input, "small");
    EXPECT_TRUE(is_soft(one));
  }
}

// The input has no reference: its distance to one is unknown, and nothing can be mixed with it.
TEST_F(Grades, NeedAValueOfTheInput) {
  const auto claims =
      graded(discs("[[claim]]\ntext = \"near\"\nmetric = \"distance_to_reference\"\n"
                   "variant = \"large\"\nvalue = 0.12\n"));
  EXPECT_EQ(claims.at(0).grade.of, Graded::not_graded);
  EXPECT_TRUE(std::isnan(claims[0].grade.least));
  EXPECT_FALSE(is_soft(claims[0]));
}

// The points are at 1 + 0.1 s radii: 0.08 and more away from the input from s = 0.8 on.
TEST_F(Grades, AreLookedForInFramesWhereTheInputIsWhatOthersAreComparedWith) {
  const auto claims =
      graded(discs("[[claim]]\ntext = \"far\"\nmetric = \"distance_to_reference\"\n"
                   "variant = \"large\"\nis = \">=\"\nvalue = 0.08\nreduce = \"min\"\n",
                   "exact"));
  EXPECT_EQ(claims.at(0).grade.of, Graded::frames);
  EXPECT_NEAR(claims[0].grade.least, 0.8, 0.051);
  EXPECT_EQ(claims[0].grade.input, "exact");
}

TEST_F(Grades, AClaimThatItsInputPassesIsGradedZero) {
  const auto claims = graded(discs(claim("radius_error", "value = 0.5\n")));
  EXPECT_EQ(claims.at(0).grade.least, 0);
  EXPECT_EQ(outcome_of(claims[0]), ClaimOutcome::not_told_apart);
}

TEST_F(Grades, ASharpClaimIsNotSoftAndOneThatFallsShortIsNotGraded) {
  // 0.2 (1 - s) <= 0.011 needs s >= 0.945: the step 0.95.
  const auto claims =
      graded(discs("[[claim]]\ntext = \"round\"\nmetric = \"radius_error\"\n"
                   "variant = \"exact\"\nvalue = 0.011\nnull = \"small\"\n" +
                   claim("radius_error", "value = 0.01\n")));
  EXPECT_EQ(claims.at(0).grade.of, Graded::frames);
  EXPECT_DOUBLE_EQ(claims[0].grade.least, 0.95);
  EXPECT_FALSE(is_soft(claims[0]));
  EXPECT_EQ(claims.at(1).grade.of, Graded::not_graded);
}

// Values alone: what the frames do not tell. Medians of -1 and 4 in three cases, mixed.
RunRecord values_of_cases() {
  RunRecord record;
  for (const double n : {1.0, 2.0, 4.0}) {
    CaseRecord& in = record.cases.emplace_back();
    in.name = "n=" + std::to_string(static_cast<int>(n));
    in.facts["vertices"] = n;
    for (const char* name : {"small", "large"}) {
      VariantRecord& variant = in.variants.emplace_back();
      variant.name = name;
      variant.status = "done";
      variant.frames = {{0, {}}, {30, {}}};
      const double value = name == std::string("small") ? n : n * n;
      variant.diagnostics["work"].values = {value, value};
    }
  }
  return record;
}

ClaimSpec works_at_least(double value) {
  ClaimSpec work;
  work.text = "works";
  work.metric = "diagnostic:work";
  work.variant = "large";
  work.is = Comparison::greater_equal;
  work.value = value;
  return work;
}

TEST_F(Grades, DiagnosticsAndStudiesMixValues) {
  const RunRecord record = values_of_cases();
  Experiment experiment;
  experiment.topic = "toy-circle";
  experiment.input = "small";
  const ClaimSpec work = works_at_least(13);
  StudySpec study;
  study.name = "growth";
  study.variant = "large";
  study.quantity = "diagnostic:work";
  study.against = "vertices";
  ClaimSpec growth;
  growth.text = "grows";
  growth.metric = "study:growth";
  growth.is = Comparison::greater_equal;
  growth.value = 1;
  experiment.claims = {work, growth};
  experiment.studies = {study};
  const std::vector<Topic> topics = toy::topics();
  Grader grader(experiment, topics, record, folder());
  const std::vector<ClaimRecord> decided = decide_claims(experiment, record);
  ASSERT_EQ(decided.size(), 4U);
  // 4 + s (16 - 4) >= 13 from s = 0.75 on.
  EXPECT_EQ(grader.grade(decided[2]).of, Graded::values);
  EXPECT_DOUBLE_EQ(grader.grade(decided[2]).least, 0.75);
  EXPECT_EQ(grader.grade(decided[3]).least, 0) << "linear growth is enough";
  EXPECT_EQ(grader.holds_at(decided[2], Graded::values, 15), true);
  EXPECT_EQ(grader.holds_at(decided[2], Graded::values, 14), false);
}

// The input's cost at the method's quality would have no rival: both are mixed.
TEST_F(Grades, MatchedStudiesMixCostAndQuality) {
  RunRecord record = values_of_cases();
  record.cases.resize(1);
  for (VariantRecord& variant : record.cases[0].variants) {
    auto& work = variant.diagnostics["work"];
    std::fill(work.values.begin(), work.values.end(), 10.0);
    variant.diagnostics["error"] = work;
    auto& error = variant.diagnostics["error"].values;
    std::fill(error.begin(), error.end(), variant.name == "small" ? 2.0 : 1.0);
  }
  StudySpec study;
  study.name = "equal";
  study.kind = StudyKind::matched;
  study.variant = "large";
  study.quantity = "diagnostic:work";
  study.match = "diagnostic:error";
  study.families = {{"small"}};
  ClaimSpec cheaper;
  cheaper.text = "cheaper";
  cheaper.metric = "study:equal";
  cheaper.is = Comparison::greater_equal;
  cheaper.value = 1.1;
  Experiment experiment;
  experiment.topic = "toy-circle";
  experiment.input = "small";
  experiment.claims = {cheaper};
  experiment.studies = {study};
  const std::vector<Topic> topics = toy::topics();
  Grader grader(experiment, topics, record, folder());
  const std::vector<ClaimRecord> decided = decide_claims(experiment, record);
  ASSERT_EQ(decided.size(), 1U);
  EXPECT_TRUE(decided[0].holds);
  EXPECT_DOUBLE_EQ(grader.grade(decided[0]).least, 0.05) << "the input itself costs what it costs";
}

// A shape that does not change, and a method that ends elsewhere.
TEST_F(Grades, PairAnInputOfOneFrameWithAllAndLastFramesWithEachOther) {
  RunRecord record = values_of_cases();
  record.cases.resize(1);
  VariantRecord &small = record.cases[0].variants[0], &large = record.cases[0].variants[1];
  large.diagnostics["work"].values = {10, 20};
  Experiment experiment;
  experiment.topic = "toy-circle";
  experiment.input = "small";
  ClaimSpec work = works_at_least(15);
  work.reduce = Reduction::last;
  experiment.claims = {work};
  const std::vector<Topic> topics = toy::topics();
  const auto grade = [&] {
    Grader grader(experiment, topics, record, folder());
    return grader.grade(decide_claims(experiment, record).at(0));
  };
  small.frames = {{7, {}}};
  small.diagnostics["work"].values = {0};
  EXPECT_DOUBLE_EQ(grade().least, 0.75) << "20 s >= 15";
  small.frames = {{7, {}}, {8, {}}, {9, {}}};
  small.diagnostics["work"].values = {0, 0, 10};
  EXPECT_DOUBLE_EQ(grade().least, 0.5) << "10 + 10 s >= 15";
  experiment.claims[0].reduce = Reduction::min;
  experiment.claims[0].value = 9;
  EXPECT_EQ(grade().least, 0) << "the first frame has no partner: the last alone is mixed";
}

TEST_F(Grades, NoneWithoutAnInputOrOfIt) {
  Experiment experiment = discs(claim("radius_error", "value = 0.12\n"));
  experiment.claims[0].variant = "small";
  experiment.claims[0].null = "exact";
  experiment.claims[0].value = 0.3;
  EXPECT_EQ(graded(experiment).at(0).grade.of, Graded::not_graded);
  experiment = discs(claim("radius_error", "value = 0.12\n"));
  experiment.input.reset();
  EXPECT_EQ(graded(experiment).at(0).grade.input, "");
}

}  // namespace
}  // namespace geoprior::test
