#include "testbed/runner/reference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

RunRecord record_of(std::map<std::string, double> values) {
  VariantRecord variant;
  variant.name = "v";
  for (const auto& [name, value] : values) {
    variant.summary[name] = {value, "m", "", "lower_is_better"};
  }
  CaseRecord in;
  in.name = "default";
  in.variants = {variant};
  RunRecord record;
  record.cases = {in};
  return record;
}

ReferenceSet blessed(std::map<std::string, double> values) {
  return bless_values(record_of(std::move(values)), {}, "first", "c1");
}

ToleranceOf tolerance(double absolute, double relative) {
  return [=](const std::string&) { return Tolerance{absolute, relative}; };
}

TEST(Reference, SurvivesAFileExactlyWithQuickAndFullApart) {
  const toy::Home home;
  Reference reference;
  reference.sets["full"] = blessed({{"error.max", 0.1 + 0.2}, {"none", std::nan("")}});
  reference.sets["quick"] = blessed({{"error.max", 1e-300}});
  const auto file = home.root() / "results/reference/toy/disc.json";
  write_reference(reference, file);
  const Reference read = read_reference(file);
  EXPECT_EQ(read.sets.at("full").at("default").at("v").at("error.max").value, 0.1 + 0.2);
  EXPECT_TRUE(std::isnan(read.sets.at("full").at("default").at("v").at("none").value));
  EXPECT_EQ(read.sets.at("quick").at("default").at("v").at("error.max").value, 1e-300);
  EXPECT_EQ(read.sets.at("quick").at("default").at("v").at("error.max").reason, "first");
  const std::string bytes = toy::Home::read(file);
  write_reference(read, file);
  EXPECT_EQ(toy::Home::read(file), bytes);
}

TEST(Reference, SaysReasonCommitAndUnitOnceASetAndOtherwiseWhereTheyDiffer) {
  const toy::Home home;
  const auto file = home.root() / "r.json";
  Reference reference;
  reference.sets["full"] =
      bless_values(record_of({{"a.max", 1}, {"a.min", 2}, {"b", 4}}),
                   blessed({{"a.max", 1}, {"a.min", 2}, {"b", 3}}), "b grew", "c2");
  reference.sets["full"]["default"]["v"]["a.min"].unit = "mm";
  write_reference(reference, file);
  const auto stored = nlohmann::json::parse(toy::Home::read(file));
  const auto& set = stored.at("full");
  EXPECT_EQ(set.at("reason"), "first");
  EXPECT_EQ(set.at("commit"), "c1");
  const auto& values = set.at("values").at("default").at("v");
  EXPECT_EQ(values.at("a.max"), 1.0);
  EXPECT_EQ(values.at("a.min"), nlohmann::json({{"unit", "mm"}, {"value", 2.0}}));
  EXPECT_EQ(values.at("b"),
            nlohmann::json({{"reason", "b grew"}, {"commit", "c2"}, {"value", 4.0}}));
  const ReferenceSet read = read_reference(file).sets.at("full");
  EXPECT_EQ(read.at("default").at("v").at("a.min").unit, "mm");
  EXPECT_EQ(read.at("default").at("v").at("a.max").reason, "first");
  EXPECT_EQ(read.at("default").at("v").at("b").commit, "c2");
}

TEST(Reference, DamagedFileIsAnErrorThatNamesIt) {
  const toy::Home home;
  const auto file = home.write("r.json", "{\"schema_version\": 1, \"full\": {\"default\": 3");
  try {
    (void)read_reference(file);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("r.json"));
  }
  EXPECT_TRUE(read_reference(home.root() / "absent.json").sets.empty());
}

TEST(Reference, ToleranceIsAbsolutePlusRelativeOfTheReference) {
  const ReferenceSet set = blessed({{"e", 10}});
  const auto mismatches = [&](double value, double absolute, double relative) {
    return compare_with_reference(record_of({{"e", value}}), set, tolerance(absolute, relative))
        .size();
  };
  EXPECT_EQ(mismatches(10, 0, 0), 0U);
  EXPECT_EQ(mismatches(11.5, 0.5, 0.1), 0U) << "0.5 + 0.1 * 10 = 1.5";
  EXPECT_EQ(mismatches(11.6, 0.5, 0.1), 1U);
  EXPECT_EQ(mismatches(8.4, 0.5, 0.1), 1U) << "a change for the better is told too";
  EXPECT_EQ(mismatches(std::nan(""), 100, 0), 1U);
}

TEST(Reference, NewAndLostMetricsAreMismatches) {
  const auto found =
      compare_with_reference(record_of({{"new", 1}}), blessed({{"old", 1}}), tolerance(1, 1));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].metric, "new");
  EXPECT_EQ(found[1].metric, "old");
  EXPECT_THAT(mismatch_text("id", found[1]), testing::HasSubstr("is gone"));
}

TEST(Reference, BlessingKeepsTheReasonOfValuesThatDidNotChange) {
  const ReferenceSet before = blessed({{"a", 1}, {"b", 2}});
  const ReferenceSet after =
      bless_values(record_of({{"a", 1}, {"b", 3}}), before, "better caps", "c2");
  EXPECT_EQ(after.at("default").at("v").at("a").reason, "first");
  EXPECT_EQ(after.at("default").at("v").at("b").reason, "better caps");
  EXPECT_EQ(after.at("default").at("v").at("b").commit, "c2");
}

TEST(Reference, ExperimentFileOverridesTheMetricTablesTolerance) {
  Topic topic;
  MetricEntry& metric = topic.metrics.emplace_back().rows.emplace_back();
  metric.name = "error";
  metric.tolerance = {1, 2};
  Experiment experiment;
  EXPECT_EQ(tolerances_of(experiment, topic)("error.max").absolute, 1);
  EXPECT_EQ(tolerances_of(experiment, topic)("error").relative, 2);
  experiment.tolerances["error"] = {5, 6};
  EXPECT_EQ(tolerances_of(experiment, topic)("error.max").absolute, 5);
}

}  // namespace
}  // namespace geoprior
