// Hashes of what the columns of a run came to: kept by bless, compared by check.
#include "testbed/runner/reference/outcomes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "testbed/runner/reference/parser.h"
#include "testbed/runner/reference/reference.h"
#include "testbed/runner/reference/text.h"
#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string kFirst(kOutcomeDigits, '1'), kSecond(kOutcomeDigits, '2'),
    kThird(kOutcomeDigits, '3');

VariantRecord column(const std::string& name, double error) {
  VariantRecord variant;
  variant.name = name;
  variant.method = "polygon";
  variant.metrics["error"].values = {0, error};
  variant.summary["error.max"].value = error;
  variant.artifacts = {{"artifacts/default/" + name + "/rim.svg", std::string(64, 'a')}};
  return variant;
}

RunRecord run_with(std::vector<VariantRecord> variants) {
  RunRecord record;
  record.cases.emplace_back().name = "default";
  record.cases.front().variants = std::move(variants);
  return record;
}

/// A topic with one metric of a frame and one that compares with a reference.
Topic topic_with_distance() {
  Topic topic;
  topic.metrics.emplace_back().rows.emplace_back().name = "error";
  topic.metrics.emplace_back().rows.emplace_back().name = "distance";
  topic.metrics.back().needs_reference = true;
  return topic;
}

std::map<std::string, std::string> outcomes_by_variant(const std::vector<VariantRecord>& variants) {
  return outcomes_of(run_with(variants), topic_with_distance()).at("default");
}

TEST(Outcomes, AreEqualExactlyWhereResultsAre) {
  VariantRecord ring = column("ring", 1);
  ring.events.emplace_back().time_s = 0.5;
  VariantRecord other_file = column("other-file", 1);
  other_file.artifacts[0].sha256.back() = 'b';
  const auto outcome = outcomes_by_variant(
      {column("base", 1), column("same", 1), column("other", 1 + 1e-15), ring, other_file});
  EXPECT_EQ(outcome.at("base"), outcome.at("same"));
  EXPECT_EQ(outcome.at("base").size(), kOutcomeDigits);
  for (const char* name : {"other", "ring", "other-file"}) {
    EXPECT_NE(outcome.at("base"), outcome.at(name)) << name;
  }
}

// The base has no distance to itself: with it, every variant would differ from it.
TEST(Outcomes, LeaveOutWhatComparesWithAnotherVariant) {
  VariantRecord measured = column("measured", 1);
  measured.metrics["distance"].values = {0, 0};
  measured.summary["distance.max"].value = 0;
  const auto outcome = outcomes_by_variant({column("base", 1), measured});
  EXPECT_EQ(outcome.at("base"), outcome.at("measured"));
}

TEST(Outcomes, LeaveOutWhatIsNotBlessedOrDoesNotRepeat) {
  Topic topic = topic_with_distance();
  topic.methods.emplace_back().name = "polygon";
  topic.methods.back().ungated = "its threads race";
  EXPECT_THAT(outcomes_of(run_with({column("base", 1)}), topic), IsEmpty());
  RunRecord record = run_with({column("base", 1)});
  record.cases.front().claims_only = true;
  EXPECT_THAT(outcomes_of(record, topic_with_distance()), IsEmpty());
}

TEST(Outcomes, AnotherIsANoticeTwoThatBecameEqualFail) {
  const Outcomes blessed{{"a", {{"v", kFirst}, {"w", kSecond}}}};
  const auto same = compare_outcomes(blessed, blessed);
  EXPECT_THAT(same.notices, IsEmpty());
  EXPECT_THAT(same.failures, IsEmpty());
  const auto other = compare_outcomes({{"a", {{"v", kThird}, {"w", kSecond}}}}, blessed);
  EXPECT_THAT(other.notices, ElementsAre("outcomes are not those blessed: v (a)"));
  EXPECT_THAT(other.failures, IsEmpty());
  // Both have moved, as on another processor, and are told apart no more.
  const auto merged = compare_outcomes({{"a", {{"v", kThird}, {"w", kThird}}}}, blessed);
  EXPECT_THAT(merged.failures,
              ElementsAre(AllOf(HasSubstr("have become equal"), HasSubstr("v (a), w (a)"))));
  const auto changed = compare_outcomes({{"a", {{"v", kFirst}}}, {"b", {{"v", kSecond}}}}, blessed);
  EXPECT_THAT(changed.notices, ElementsAre("outcomes are new (bless to hold them): v (b)"));
  EXPECT_THAT(changed.failures, ElementsAre(HasSubstr("w (a)")));
}

TEST(Outcomes, ThatWereEqualMayStaySo) {
  const Outcomes blessed{{"a", {{"v", kFirst}, {"w", kFirst}}}};
  EXPECT_THAT(compare_outcomes({{"a", {{"v", kSecond}, {"w", kSecond}}}}, blessed).failures,
              IsEmpty());
}

TEST(Outcomes, StandInTheReferenceALineEach) {
  BlessedSet set;
  set.blessing = {"c1", "first"};
  set.values["n=1"]["v"]["error.max"] = {0.5, "m"};
  set.outcomes = {{"n=1", {{"v", kFirst}, {"w", kFirst}}}, {"n=2", {{"v", kSecond}}}};
  const std::string text = reference_text({{"quick", set}});
  EXPECT_THAT(text, HasSubstr("0.5\noutcome n=1 v " + kFirst + " w " + kFirst + "\noutcome n=2 v " +
                              kSecond + "\n\nend 4\n"));
  const Reference read = parse_reference(text, "r.txt");
  EXPECT_EQ(read.at("quick").outcomes, set.outcomes);
  EXPECT_EQ(reference_text(read), text);
}

class OutcomesOfProgram : public testing::Test {
 protected:
  /// Two polygons, the second with other options, and perhaps a `[check]`.
  void write(const std::string& second_options, bool outcomes = true) const {
    const std::string more = "[[variant]]\nname = \"second\"\nmethod = \"polygon\"\noptions = { " +
                             second_options + " }\n" + toy::kPlotted +
                             (outcomes ? "[check]\noutcomes = true\n" : "");
    home_.write("experiments/toy-circle/disc.toml", toy::disc_experiment("segments = 16", more));
  }

  toy::Home home_;
};

TEST_F(OutcomesOfProgram, AreBlessedAndHeldByCheck) {
  write("segments = 16, corner = \"outside\"");
  ASSERT_EQ(home_.run("bless toy-circle/disc --reason first").code, 0);
  const Reference reference =
      read_reference(home_.root() / "results/reference/toy-circle/disc.txt");
  const auto& outcomes = reference.at("full").outcomes.at("default");
  EXPECT_EQ(outcomes.size(), 3U);
  EXPECT_NE(outcomes.at("polygon"), outcomes.at("second"));
  const toy::Outcome same = home_.run("check toy-circle/disc");
  EXPECT_EQ(same.code, 0);
  EXPECT_THAT(same.err, Not(HasSubstr("outcome")));
  write("segments = 16");
  const toy::Outcome merged = home_.run("check toy-circle/disc");
  EXPECT_EQ(merged.code, 1);
  EXPECT_THAT(merged.err, HasSubstr("an option has stopped to do anything: polygon (default), "
                                    "second (default)"));
}

TEST_F(OutcomesOfProgram, AreKeptOnlyWhereTheExperimentAsks) {
  write("segments = 8", false);
  ASSERT_EQ(home_.run("bless toy-circle/disc --reason first").code, 0);
  const std::string file = "results/reference/toy-circle/disc.txt";
  EXPECT_THAT(toy::Home::read(home_.root() / file), Not(HasSubstr("outcome ")));
  write("segments = 8");
  const toy::Outcome asked = home_.run("check toy-circle/disc");
  EXPECT_EQ(asked.code, 0) << asked.err;
  EXPECT_THAT(asked.err, HasSubstr("outcomes are new (bless to hold them): exact (default)"));
}

}  // namespace
}  // namespace geoprior
