#include "testbed/runner/reference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/runner/reference_diff.h"
#include "testbed/runner/reference_parser.h"
#include "testbed/runner/reference_text.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Gates of a topic whose every metric in `names` has the tolerance.
Gates gates_with(const std::vector<std::string>& names, Tolerance tolerance) {
  Topic topic;
  for (const std::string& name : names) {
    MetricEntry entry;
    entry.name = name;
    entry.tolerance = tolerance;
    topic.metrics.emplace_back().rows.push_back(entry);
  }
  return {Experiment{}, topic};
}

/// Values in m of variant "v" in case "default".
GatedValues values_named(const std::map<std::string, double>& named) {
  GatedValues values;
  for (const auto& [name, value] : named) values["default"]["v"][name] = {value, "m"};
  return values;
}

ReferenceSet blessed_exactly(const std::map<std::string, double>& named,
                             const Blessing& blessing = {"c1", "first"}) {
  return bless_values(values_named(named), {}, gates_with({}, {}), blessing);
}

const std::map<std::string, double> kFrames{
    {"error.min", 0}, {"error.median", 0.25}, {"error.max", 0.5}, {"error.last", 0.125}};

TEST(ReferenceText, IsOneLineAMetricVariantAndCase) {
  Reference reference;
  std::map<std::string, double> named = kFrames;
  named["events"] = 12;
  for (const char* which : {".min", ".median", ".max", ".last"}) {
    named[std::string("rest") + which] = 0;
  }
  reference.sets["full"] = blessed_exactly(named);
  reference.contents["full"] = {"x86-64-v3", std::string(64, 'a')};
  EXPECT_EQ(reference_text(reference),
            "geoprior reference 3\n"
            "[1] c1 \"first\"\n"
            "\n"
            "set full [1]\n"
            "content x86-64-v3 " +
                std::string(64, 'a') +
                "\n"
                "unit m error events rest\n"
                "# metric  variant  case     min          median       max          last\n"
                "  error   v        default  0            0.25         0.5          0.125\n"
                "  events  v        default  12\n"
                "  rest    v        default  = 0\n");
}

TEST(ReferenceText, SurvivesAFileExactlyWithQuickAndFullApart) {
  const toy::Home home;
  Reference reference;
  reference.sets["full"] = blessed_exactly({{"sum", 0.1 + 0.2}, {"none", std::nan("")}});
  reference.sets["full"]["seed=*"][""]["shortfall:a \"claim\" \\ of\ntwo lines"] = {
      std::numeric_limits<double>::infinity(), "kg m/s", "other", "c2"};
  reference.sets["quick"] = blessed_exactly({{"sum", 1e-300}});
  const auto file = home.root() / "results/reference/toy/disc.txt";
  write_reference(reference, file);
  const Reference read = read_reference(file);
  const auto& full = read.sets.at("full");
  EXPECT_EQ(full.at("default").at("v").at("sum").value, 0.1 + 0.2);
  EXPECT_TRUE(std::isnan(full.at("default").at("v").at("none").value));
  const ReferenceValue& odd = full.at("seed=*").at("").at("shortfall:a \"claim\" \\ of\ntwo lines");
  EXPECT_TRUE(std::isinf(odd.value));
  EXPECT_EQ(odd.unit, "kg m/s");
  EXPECT_EQ(odd.reason, "other");
  EXPECT_EQ(odd.commit, "c2");
  EXPECT_EQ(read.sets.at("quick").at("default").at("v").at("sum").value, 1e-300);
  EXPECT_FALSE(read.contents.contains("full"));
  const std::string bytes = toy::Home::read(file);
  write_reference(read, file);
  EXPECT_EQ(toy::Home::read(file), bytes);
}

TEST(ReferenceText, BlessingsKeepTheirNumbersAndLinesSayTheUnusual) {
  const Gates gates = gates_with({}, {});
  Reference reference;
  reference.sets["full"] = blessed_exactly({{"a", 1}, {"b", 2}, {"c", 3}});
  reference = parse_reference(reference_text(reference), "r");
  const auto bless = [&](const std::map<std::string, double>& named, const Blessing& by) {
    ReferenceSet& set = reference.sets["full"];
    set = bless_values(values_named(named), set, gates, by);
    const std::string text = reference_text(reference);
    reference = parse_reference(text, "r");
    return text;
  };
  EXPECT_THAT(bless({{"a", 1}, {"b", 9}, {"c", 3}}, {"c2", "b grew"}),
              AllOf(HasSubstr("[1] c1 \"first\"\n[2] c2 \"b grew\"\n"), HasSubstr("set full [1]\n"),
                    HasSubstr("default  9  [2]\n"), HasSubstr("default  1\n")));
  const std::string third = bless({{"a", 1}, {"b", 8}, {"c", 3}}, {"c3", "b fell"});
  EXPECT_THAT(third, AllOf(HasSubstr("[1] c1"), Not(HasSubstr("[2]")), HasSubstr("[3] c3")));
}

TEST(ReferenceText, WhatIsMalformedIsNamedByFileAndLine) {
  const std::string head = "geoprior reference 3\n[1] c1 \"first\"\n";
  const std::string set = head + "set full [1]\nunit m error\n";
  const std::string row = "  error v default 1 2 3 2\n";
  EXPECT_EQ(parse_reference(set + row, "r.txt").sets.at("full").at("default").at("v").size(), 4U);
  const std::vector<std::pair<std::string, std::string>> malformed{
      {"", "r.txt:1"},
      {"geoprior reference 2\n", "r.txt:1"},
      {head + "[1] c2 \"again\"\n", "r.txt:3: blessing [1] is there twice"},
      {head + "[2] c2 unquoted\n", "r.txt:3: is no blessing"},
      {head + "[0] c2 \"zero\"\n", "r.txt:3: '[0]' is no mark"},
      {head + "[2] c2 \"open\n", "r.txt:3: a quote is not closed"},
      {head + "sets full\n", "r.txt:3: 'sets' begins no line"},
      {head + "set half [1]\n", "r.txt:3: there is no set 'half'"},
      {head + "set full [2]\n", "r.txt:3: there is no blessing [2]"},
      {head + row, "r.txt:3: belongs to no set"},
      {head + "unit m error\n", "r.txt:3: belongs to no set"},
      {head + "content x86-64 " + std::string(64, 'a') + "\n", "r.txt:3: belongs to no set"},
      {set + "set full [1]\n", "r.txt:5: set full is there twice"},
      {set + "[2] c2 \"late\"\n", "r.txt:5: a blessing is listed before"},
      {set + "content x86-64 abc\n", "r.txt:5: is no hash"},
      {set + "unit mm error\n", "r.txt:5: metric 'error' has two units"},
      {set + "unit mm\n", "r.txt:5: is the unit of nothing"},
      {set + "  error v default\n", "r.txt:5: has 3 columns"},
      {set + "  error v default 1 2\n", "r.txt:5: has 5 columns"},
      {set + "  error v default 1 2 3\n", "r.txt:5: has 6 columns"},
      {set + "  error v default 1 2 3 2 5\n", "r.txt:5: has 8 columns"},
      {set + "  error v default = 1 2\n", "r.txt:5: has 6 columns"},
      {set + "  error v default 1 2 3 x\n", "r.txt:5: 'x' is no number"},
      {set + "  error v default 1 2 3 2m\n", "r.txt:5: '2m' is no number"},
      {set + "  error v default 1 2 3 2 [7]\n", "r.txt:5: there is no blessing [7]"},
      {set + "  error\tv default 1\n", "r.txt:5: 'error\tv' has a quote or a tab"},
      {set + "  other v default 1\n", "r.txt:5: metric 'other' has no unit"},
      {set + "   \n", "r.txt:5: is blank but for spaces"},
      {set + row + row, "r.txt:6: metric 'error' of variant 'v' in case 'default' is there twice"},
      {set + row + "  error v default 1\n", "r.txt:6: metric 'error' of variant 'v'"},
      {set + "  error v default 1\n" + row, "r.txt:6: metric 'error' of variant 'v'"},
      {head + "set full\nunit m error\n" + row, "r.txt:5: says not how it was blessed"},
  };
  for (const auto& [text, where] : malformed) {
    const std::string said = test::error_of([&] { (void)parse_reference(text, "r.txt"); });
    // Errors say "where: what (allowed)".
    EXPECT_THAT(said, HasSubstr(where)) << text;
  }
}

TEST(ReferenceText, WantsAllStatisticsOfAMetricAndOneUnit) {
  Reference reference;
  reference.sets["full"] = blessed_exactly({{"error.max", 1}});
  EXPECT_THAT(test::error_of([&] { (void)reference_text(reference); }), HasSubstr("'error'"));
  reference.sets["full"] = blessed_exactly({{"events", 1}});
  reference.sets["full"]["default"]["w"]["events"] = {1, "s", "first", "c1"};
  EXPECT_THAT(test::error_of([&] { (void)reference_text(reference); }), HasSubstr("two units"));
}

TEST(Reference, AFileOfTheOldFormIsRefusedByName) {
  const toy::Home home;
  home.write("r.json", "{\"schema_version\": 2}");
  EXPECT_THAT(test::error_of([&] { (void)read_reference(home.root() / "r.txt"); }),
              AllOf(HasSubstr("r.json"), HasSubstr("old form"), HasSubstr("geoprior bless")));
  EXPECT_TRUE(read_reference(home.root() / "absent.txt").sets.empty());
}

TEST(Reference, RoundingMovesNoValueByMoreThanATenthOfItsTolerance) {
  EXPECT_EQ(rounded_for(0.1234567890123, {0, 1e-3}), 0.12346);
  EXPECT_EQ(rounded_for(0.1234567890123, {1e-2, 0}), 0.123);
  EXPECT_EQ(rounded_for(4.4e-16, {1e-12, 1e-6}), 0) << "round-off";
  EXPECT_EQ(rounded_for(123456, {1, 0.02}), 123500) << "2 % of it is 2469";
  EXPECT_EQ(rounded_for(0.1 + 0.2, {0, 0}), 0.1 + 0.2) << "no tolerance: no rounding";
  EXPECT_TRUE(std::isnan(rounded_for(std::nan(""), {1, 1})));
  EXPECT_TRUE(std::isinf(rounded_for(-std::numeric_limits<double>::infinity(), {1, 1})));
  double value = 1.2345678901234567e-9;
  for (int i = 0; i < 400; ++i, value *= -1.17) {
    for (const Tolerance t : {Tolerance{1e-12, 1e-6}, {1e-6, 0.1}, {0.01, 0}, {0, 1e-3}}) {
      const double allowed = t.absolute + t.relative * std::abs(value);
      const double rounded = rounded_for(value, t);
      EXPECT_LE(std::abs(rounded - value), 0.1 * allowed) << value;
    }
  }
}

/// A set of the old form: {"units": {metric: unit}, "values": {case: {variant: {name: number}}}}.
GatedValues values_of_old_form(const nlohmann::json& set) {
  GatedValues values;
  for (const auto& [in, variants] : set.at("values").items()) {
    for (const auto& [variant, named] : variants.items()) {
      for (const auto& [name, value] : named.items()) {
        const std::string unit = set.at("units").at(name.substr(0, name.rfind('.')));
        values[in][variant][name] = {value, unit};
      }
    }
  }
  return values;
}

TEST(Reference, ConversionOfAnOldFileMovesNoValueByMoreThanATenthOfItsTolerance) {
  const auto old = nlohmann::json::parse(toy::Home::read(
      std::filesystem::path(GEOPRIOR_SOURCE_DIR) / "tests/testbed/old_reference.json"));
  const GatedValues values = values_of_old_form(old.at("quick"));
  std::vector<std::string> metrics;
  for (const auto& [metric, unit] : old.at("quick").at("units").items()) metrics.push_back(metric);
  const Tolerance tolerance{1e-12, 1e-6};
  const Gates gates = gates_with(metrics, tolerance);
  Reference reference;
  reference.sets["quick"] = bless_values(values, {}, gates, {"c1", "first"});
  const Reference read = parse_reference(reference_text(reference), "converted");
  std::size_t compared = 0;
  for (const auto& [in, variants] : values) {
    for (const auto& [variant, named] : variants) {
      for (const auto& [name, value] : named) {
        const ReferenceValue* now = find_value(read.sets.at("quick"), in, variant, name);
        ASSERT_NE(now, nullptr) << name;
        EXPECT_EQ(now->unit, value.unit) << name;
        const double allowed = tolerance.absolute + tolerance.relative * std::abs(value.value);
        EXPECT_LE(std::abs(now->value - value.value), 0.1 * allowed) << name;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 100U);
  EXPECT_TRUE(compare_with_reference(values, read.sets.at("quick"), gates).empty());
}

TEST(Reference, ToleranceIsAbsolutePlusRelativeOfTheReference) {
  const ReferenceSet set = blessed_exactly({{"e", 10}});
  const auto mismatches = [&](double value, double absolute, double relative) {
    return compare_with_reference(values_named({{"e", value}}), set,
                                  gates_with({"e"}, {absolute, relative}))
        .size();
  };
  EXPECT_EQ(mismatches(10, 0, 0), 0U);
  EXPECT_EQ(mismatches(11.5, 0.5, 0.1), 0U) << "0.5 + 0.1 * 10 = 1.5";
  EXPECT_EQ(mismatches(11.6, 0.5, 0.1), 1U);
  EXPECT_EQ(mismatches(8.4, 0.5, 0.1), 1U) << "a change for the better is told too";
  EXPECT_EQ(mismatches(std::nan(""), 100, 0), 1U);
}

TEST(Reference, NewAndLostMetricsAreMismatches) {
  const auto found = compare_with_reference(values_named({{"new", 1}}),
                                            blessed_exactly({{"old", 1}}), gates_with({}, {}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].metric, "new");
  EXPECT_EQ(found[1].metric, "old");
  EXPECT_THAT(mismatch_text("id", found[1]), HasSubstr("is gone"));
}

TEST(Reference, BlessingKeepsTheReasonOfValuesThatDidNotChange) {
  const ReferenceSet before = blessed_exactly({{"a", 1}, {"b", 2}});
  const ReferenceSet after = bless_values(values_named({{"a", 1 + 1e-9}, {"b", 3}}), before,
                                          gates_with({"a", "b"}, {0, 1e-6}), {"c2", "better caps"});
  EXPECT_EQ(after.at("default").at("v").at("a").reason, "first") << "the same when rounded";
  EXPECT_EQ(after.at("default").at("v").at("a").value, 1);
  EXPECT_EQ(after.at("default").at("v").at("b").reason, "better caps");
  EXPECT_EQ(after.at("default").at("v").at("b").commit, "c2");
}

TEST(Reference, DifferenceShowsTheFarthestFirstAndCountsTheRest) {
  const ReferenceSet before = blessed_exactly({{"a.max", 1}, {"b", 2}, {"c", 3}, {"old", 1}});
  const ReferenceSet after = blessed_exactly({{"a.max", 1.5}, {"b", 4}, {"c", 3}, {"new", 1}});
  const auto changes = changes_of(before, after, gates_with({"a", "b"}, {0.1, 0}));
  EXPECT_THAT(
      difference_lines(changes, 10),
      ElementsAre("b, v, default: 2 -> 4 m (20 tolerances)",
                  "a.max, v, default: 1 -> 1.5 m (5 tolerances)", "1 new: new 1", "1 gone: old 1"));
  EXPECT_THAT(difference_lines(changes, 1),
              ElementsAre(HasSubstr("b, v"), "1 more moved: a 1", "1 new: new 1", "1 gone: old 1"));
}

TEST(Reference, ExperimentFileOverridesTheMetricTablesTolerance) {
  Topic topic;
  MetricEntry& metric = topic.metrics.emplace_back().rows.emplace_back();
  metric.name = "error";
  metric.tolerance = {1, 2};
  Experiment experiment;
  EXPECT_EQ(Gates(experiment, topic).of("v", "error.max").tolerance.absolute, 1);
  EXPECT_EQ(Gates(experiment, topic).of("v", "error").tolerance.relative, 2);
  experiment.tolerances["error"] = {5, 6};
  EXPECT_EQ(Gates(experiment, topic).of("v", "error.max").tolerance.absolute, 5);
}

}  // namespace
}  // namespace geoprior
