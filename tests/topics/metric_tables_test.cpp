// The metric tables of all topics, those of the tests among them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "experiments/toy/toy_topic.h"
#include "testbed/topic.h"

namespace geoprior::test {
namespace {

class MetricTables : public ::testing::TestWithParam<Topic> {};

bool is_snake_case(const std::string& name) {
  const auto fits = [](unsigned char c) {
    return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), fits);
}

TEST_P(MetricTables, EveryRowIsComplete) {
  std::set<std::string> names;
  for (const MetricEntry& row : metric_rows(GetParam())) {
    EXPECT_TRUE(is_snake_case(row.name)) << row.name;
    EXPECT_TRUE(names.insert(row.name).second) << row.name << " twice";
    EXPECT_FALSE(row.unit.empty()) << row.name;
    EXPECT_GE(row.definition.size(), 20U) << row.name;
    EXPECT_GE(row.tolerance.absolute, 0) << row.name;
    EXPECT_GE(row.tolerance.relative, 0) << row.name;
    const bool exact = row.tolerance.absolute == 0 && row.tolerance.relative == 0;
    EXPECT_TRUE(!exact || row.unit == "1") << row.name << ": only counts are compared exactly";
    EXPECT_TRUE(std::isfinite(row.target)) << row.name;
    EXPECT_TRUE(row.target == 0 || row.direction == Direction::closer_to_target) << row.name;
    // What `check` leaves alone has a reason that one can read.
    EXPECT_TRUE(row.gated() || row.ungated.size() >= 20) << row.name;
    EXPECT_EQ(find_metric(GetParam(), row.name), &row);
  }
  EXPECT_EQ(find_metric(GetParam(), "no_such_metric"), nullptr);
}

TEST_P(MetricTables, DiagnosticsNameTheMetricThatMeasuresTheSameOrWhyNoneDoes) {
  for (const DiagnosticEntry& row : GetParam().diagnostics) {
    EXPECT_TRUE(is_snake_case(row.name)) << row.name;
    EXPECT_NE(row.metric.empty(), row.unmeasured.size() < 20) << row.name;
    EXPECT_TRUE(row.metric.empty() || find_metric(GetParam(), row.metric) != nullptr) << row.name;
    EXPECT_EQ(find_diagnostic(GetParam(), row.name), &row);
  }
}

TEST_P(MetricTables, EveryGroupMeasuresOnceForItsRows) {
  for (const MetricGroup& group : GetParam().metrics) {
    ASSERT_FALSE(group.rows.empty());
    const std::string& first = group.rows.front().name;
    EXPECT_NE(static_cast<bool>(group.of_frame), static_cast<bool>(group.of_sequence)) << first;
    EXPECT_TRUE(!group.needs_reference || group.of_frame) << first;
    EXPECT_TRUE(group.needs_reference || group.reference_parts.empty()) << first;
  }
}

/// "skinning rest_identity", … of the table under "Oracles" of docs/metrics.md: topic and rows are
/// in its first column.
std::set<std::string> documented_oracles() {
  const std::regex first_column("^\\| (\\w+) (`[^|]*)"), name("`(\\w+)`");
  std::ifstream page(GEOPRIOR_SOURCE_DIR "/docs/metrics.md");
  std::set<std::string> oracles;
  std::string line;
  while (std::getline(page, line) && !line.starts_with("**Oracles**")) {
  }
  while (std::getline(page, line) && !line.starts_with("## ")) {
    std::smatch column;
    if (!std::regex_search(line, column, first_column)) continue;
    const std::string rows = column[2];
    for (std::sregex_iterator row(rows.begin(), rows.end(), name), end; row != end; ++row) {
      oracles.insert(column.str(1) + " " + row->str(1));
    }
  }
  return oracles;
}

TEST(Oracles, AreThoseOfTheDocumentation) {
  std::set<std::string> documented = documented_oracles(), marked;
  const auto of_a_topic_left_out = [](const std::string& name) {
    const auto is_topic = [&](const Topic& topic) { return name.starts_with(topic.name + " "); };
    const std::vector<Topic> topics = all_topics();
    return std::none_of(topics.begin(), topics.end(), is_topic);
  };
  std::erase_if(documented, of_a_topic_left_out);
  for (const Topic& topic : all_topics()) {
    for (const MetricEntry& row : metric_rows(topic)) {
      if (row.oracle) marked.insert(topic.name + " " + row.name);
    }
  }
  EXPECT_EQ(marked, documented);
}

std::vector<Topic> with_toys() {
  std::vector<Topic> topics = all_topics();
  for (Topic& topic : toy::topics()) topics.push_back(std::move(topic));
  return topics;
}

std::string test_name(const ::testing::TestParamInfo<Topic>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Topics, MetricTables, ::testing::ValuesIn(with_toys()), test_name);

}  // namespace
}  // namespace geoprior::test
