#include "testbed/runner/reference/reference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "core/error.h"
#include "testbed/runner/reference/diff.h"
#include "testbed/runner/reference/parser.h"
#include "testbed/runner/reference/text.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

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

ReferenceSet blessed_exactly(const std::map<std::string, double>& named) {
  return bless_values(values_named(named), gates_with({}, {}));
}

BlessedSet set_of(ReferenceSet values, const Blessing& blessing = {"c1", "first"}) {
  return {blessing, std::nullopt, std::nullopt, std::move(values)};
}

const std::string kHashA(64, 'a'), kHashB(64, 'b');

TEST(ReferenceText, IsOneLineAMetricWithTheVariantsSideBySide) {
  ReferenceSet values;
  for (const char* in : {"n=1", "n=2"}) {
    values[in]["v"]["error.max"] = {0.5, "m"};
    values[in]["a-long-variant"]["error.max"] = {0.25, "m"};
    values[in]["v"]["events"] = {in == std::string("n=1") ? 12.0 : 13.0, "1"};
  }
  values["n=2"]["a-long-variant"]["events"] = {std::nan(""), "1"};
  values[""][""]["study:rate of\ttwo"] = {2, "1"};
  BlessedSet set = set_of(values);
  set.content = ContentHash{"x86-64-v3", kHashA, kHashB};
  set.processor_s = 3.14159;
  EXPECT_EQ(reference_text({{"quick", set}}),
            "geoprior reference 5\n"
            "\n"
            "set quick\n"
            "blessed c1 \"first\"\n"
            "frames x86-64-v3 " +
                kHashA +
                "\n"
                "metrics " +
                kHashB +
                "\n"
                "cost 3.1 s\n"
                "unit 1 events \"study:rate of\ttwo\"\n"
                "unit m error.max\n"
                "cases n=1 n=2\n"
                "variants          a-long-variant  v\n"
                "  error.max  *    0.25            0.5\n"
                "  events     n=1  -               12\n"
                "  events     n=2  nan             13\n"
                "  \"study:rate of\ttwo\" - = 2\n"
                "\n"
                "end 4\n");
}

TEST(ReferenceText, CasesWithEqualRowsAreStoredOnce) {
  ReferenceSet values;
  for (const char* in : {"4k,threads=1", "4k,threads=2", "8k,threads=1", "8k,threads=2"}) {
    values[in]["v"]["error.max"] = {in[0] == '4' ? 1.0 : 2.0, "m"};
    values[in]["v"]["rest"] = {0, "m"};
  }
  const std::string text = reference_text({{"full", set_of(values)}});
  EXPECT_THAT(text, AllOf(HasSubstr("error.max  4k,threads=1|4k,threads=2  1\n"),
                          HasSubstr("error.max  8k,threads=1|8k,threads=2  2\n"),
                          HasSubstr("rest       *"), HasSubstr("end 3\n")));
  const ReferenceSet read = parse_reference(text, "r").at("full").values;
  ASSERT_EQ(read.size(), 4U);
  EXPECT_EQ(read.at("8k,threads=2").at("v").at("error.max").value, 2);
  // A run in which one of two equal cases moves is told, and only that case.
  GatedValues now;
  visit_values(read, [&](const auto& in, const auto& variant, const auto& name, const auto& v) {
    now[in][variant][name] = {v.value, v.unit};
  });
  now["4k,threads=2"]["v"]["error.max"].value = 1.5;
  const auto found = compare_with_reference(now, read, gates_with({}, {}));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].case_name, "4k,threads=2");
}

TEST(ReferenceText, SurvivesAFileExactlyWithQuickAndFullApart) {
  const toy::Home home;
  Reference reference;
  reference["full"] = set_of(blessed_exactly({{"sum", 0.1 + 0.2}, {"none", std::nan("")}}));
  const std::string odd_name = "shortfall:a \"claim\" \\ of\ntwo lines";
  reference["full"].values["seed=*"][""][odd_name] = {std::numeric_limits<double>::infinity(),
                                                      "kg m/s"};
  reference["full"].content = ContentHash{"x86-64-v3", "", "", kHashB};
  reference["quick"] = set_of(blessed_exactly({{"sum", 1e-300}}), {"c2", "a \"reason\""});
  reference["quick"].content = ContentHash{"x86-64", kHashA, kHashB};
  const auto file = home.root() / "results/reference/toy/disc.txt";
  write_reference(reference, file);
  const Reference read = read_reference(file);
  const ReferenceSet& full = read.at("full").values;
  EXPECT_EQ(full.at("default").at("v").at("sum").value, 0.1 + 0.2);
  EXPECT_TRUE(std::isnan(full.at("default").at("v").at("none").value));
  const ReferenceValue& odd = full.at("seed=*").at("").at(odd_name);
  EXPECT_TRUE(std::isinf(odd.value));
  EXPECT_EQ(odd.unit, "kg m/s");
  EXPECT_EQ(read.at("full").content->content, kHashB);
  EXPECT_EQ(read.at("quick").content->frames, kHashA);
  EXPECT_EQ(read.at("quick").content->metrics, kHashB);
  EXPECT_EQ(read.at("quick").blessing.reason, "a \"reason\"");
  EXPECT_EQ(read.at("quick").values.at("default").at("v").at("sum").value, 1e-300);
  const std::string bytes = toy::Home::read(file);
  write_reference(read, file);
  EXPECT_EQ(toy::Home::read(file), bytes);
}

// Wherever the file is cut, reading it is an error that names the file and a line.
TEST(ReferenceText, AFileCutAnywhereIsRefused) {
  BlessedSet set = set_of(blessed_exactly({{"a.max", 1.25}, {"b.max", 22}, {"c", 333}}));
  set.content = ContentHash{"x86-64", kHashA, kHashB};
  const std::string text = reference_text({{"full", set}, {"quick", set}});
  ASSERT_NO_THROW((void)parse_reference(text, "r.txt"));
  for (std::size_t size = 0; size + 1 < text.size(); ++size) {
    const std::string said =
        test::error_of([&] { (void)parse_reference(text.substr(0, size), "r.txt"); });
    EXPECT_THAT(said, HasSubstr("r.txt:")) << "the first " << size << " bytes";
  }
}

TEST(ReferenceText, WhatIsMalformedIsNamedByFileAndLine) {
  const std::string head = "geoprior reference 5\n";
  const std::string set =
      head + "set full\nblessed c1 \"first\"\nunit m error\ncases a b\nvariants v w\n";
  const std::string row = "  error a 1 2\n";
  EXPECT_EQ(parse_reference(set + row + "end 1\n", "r.txt").at("full").values.at("a").size(), 2U);
  const std::vector<std::pair<std::string, std::string>> malformed{
      {"", "r.txt:1"},
      {"geoprior reference 3\n", "r.txt:1: is no reference file of this form, or of an older one"},
      {head + "sets full\n", "r.txt:2: 'sets' begins no line"},
      {head + "set half\n", "r.txt:2: there is no set 'half'"},
      {head + "set\n", "r.txt:2: is no line of this kind"},
      {head + row, "r.txt:2: belongs to no set"},
      {head + "unit m error\n", "r.txt:2: belongs to no set"},
      {head + "set full\nend 0\n", "r.txt:3: the set before says not how it was blessed"},
      {head + "set full\nblessed c1 unquoted\n", "r.txt:3: is no blessing"},
      {head + "set full\nblessed c1 \"open\n", "r.txt:3: a quote is not closed"},
      {set + "set full\n", "r.txt:7: set full is there twice"},
      {set + "blessed c2 \"late\"\n", "r.txt:7: the blessing of the set is there twice"},
      {set + "content x86-64 abc\n", "r.txt:7: 'abc' is no hash"},
      {set + "metrics " + kHashA + "\n", "r.txt:7: stands behind no line of frames"},
      {set + "frames x86 " + kHashA + "\nend 0\n", "r.txt:8: the set before has frames and no"},
      {set + "content x " + kHashA + "\nframes x " + kHashA + "\n",
       "r.txt:8: the content is there"},
      {set + "cost 3 h\n", "r.txt:7: is no cost"},
      {set + "unit mm error\n", "r.txt:7: metric 'error' has two units"},
      {set + "unit mm\n", "r.txt:7: is the unit of nothing"},
      {set + "variants x\n", "r.txt:7: the variants of the set is there twice"},
      {set + "  error a\n", "r.txt:7: has 2 columns"},
      {set + "  error a 1\n", "r.txt:7: has 3 columns"},
      {set + "  error a 1 2 3\n", "r.txt:7: has 5 columns"},
      {set + "  error a = x\n", "r.txt:7: 'x' is no number"},
      {set + "  error a 1 2m\n", "r.txt:7: '2m' is no number"},
      {set + "  error c 1 2\n", "r.txt:7: there is no case 'c'"},
      {set + "  error\ta 1 2\n", "r.txt:7: 'error\ta' has a quote or a tab"},
      {set + "  other a 1 2\n", "r.txt:7: metric 'other' has no unit"},
      {set + "   \n", "r.txt:7: is blank but for spaces"},
      {set + row + row, "r.txt:8: metric 'error' of variant 'v' in case 'a' is there twice"},
      {set + row + "  error * 1 2\n", "r.txt:8: metric 'error' of variant 'v' in case 'a'"},
      {set + row, "r.txt:8: the file is cut off"},
      {head + "outcome a v 0123456789ab\n", "r.txt:2: belongs to no set"},
      {set + "outcome a v\n", "r.txt:7: is no line of this kind"},
      {set + "outcome a v 0123456789\n", "r.txt:7: '0123456789' is no outcome"},
      {set + "outcome a v 0123456789AB\n", "r.txt:7: '0123456789AB' is no outcome"},
      {set + "outcome a v 0123456789ab\noutcome a v 0123456789ab\n",
       "r.txt:8: the outcome of variant 'v' in case 'a' is there twice"},
      {set + row + "outcome a v 0123456789ab\nend 1\n", "r.txt:9: the file has 2 rows and not 1"},
      {set + row + "end 2\n", "r.txt:8: the file has 1 rows and not 2"},
      {set + row + "end 1\n" + row, "r.txt:9: stands behind the end"},
  };
  for (const auto& [text, where] : malformed) {
    const std::string said = test::error_of([&] { (void)parse_reference(text, "r.txt"); });
    // Errors say "where: what (allowed)".
    EXPECT_THAT(said, HasSubstr(where)) << text;
  }
}

TEST(ReferenceText, AFewBytesCannotStandForMillionsOfValues) {
  std::string text = "geoprior reference 5\nset full\nblessed c \"r\"\nunit m e\ncases",
              row = "  e *";
  for (int i = 0; i < 2000; ++i) text += " c" + std::to_string(i);
  text += "\nvariants";
  for (int i = 0; i < 2000; ++i) {
    text += " v" + std::to_string(i);
    row += " 1";
  }
  EXPECT_THAT(test::error_of([&] { (void)parse_reference(text + "\n" + row + "\n", "r"); }),
              HasSubstr("over a million values"));
}

TEST(ReferenceText, WantsOneUnitOfAMetric) {
  ReferenceSet values = blessed_exactly({{"events", 1}});
  values["default"]["w"]["events"] = {1, "s"};
  EXPECT_THAT(test::error_of([&] {
                (void)reference_text({{"full", set_of(values)}});
              }),
              HasSubstr("two units"));
}

TEST(Reference, AMissingFileIsEmpty) {
  const toy::Home home;
  EXPECT_TRUE(read_reference(home.root() / "absent.txt").empty());
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

// A new row of the metric table, or a new claim, fails no experiment; a value that is missing where
// others of its metric are there does.
TEST(Reference, ANewMetricIsANoticeALostOneFails) {
  const auto found = compare_with_reference(values_named({{"new", 1}}),
                                            blessed_exactly({{"old", 1}}), gates_with({}, {}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].metric, "new");
  EXPECT_FALSE(found[0].fails);
  EXPECT_EQ(found[1].metric, "old");
  EXPECT_TRUE(found[1].fails);
  EXPECT_THAT(mismatch_text("id", found[1]), HasSubstr("is gone"));
  GatedValues now = values_named({{"old", 1}});
  now["default"]["another"]["old"] = {1, "m"};
  const auto missing =
      compare_with_reference(now, blessed_exactly({{"old", 1}}), gates_with({}, {}));
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_TRUE(missing[0].fails);
  EXPECT_EQ(missing[0].variant, "another");
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
