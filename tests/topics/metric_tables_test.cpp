// The metric tables of all topics, those of the tests among them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
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
    EXPECT_TRUE(std::isfinite(row.target)) << row.name;
    if (row.target != 0) EXPECT_EQ(row.direction, Direction::closer_to_target) << row.name;
    // What `check` leaves alone has a reason that one can read.
    if (!row.gated()) EXPECT_GE(row.ungated.size(), 20U) << row.name;
    EXPECT_EQ(find_metric(GetParam(), row.name), &row);
  }
  EXPECT_EQ(find_metric(GetParam(), "no_such_metric"), nullptr);
}

TEST_P(MetricTables, EveryGroupMeasuresOnceForItsRows) {
  for (const MetricGroup& group : GetParam().metrics) {
    ASSERT_FALSE(group.rows.empty());
    const std::string& first = group.rows.front().name;
    EXPECT_NE(static_cast<bool>(group.of_frame), static_cast<bool>(group.of_sequence)) << first;
    if (group.needs_reference) EXPECT_TRUE(group.of_frame) << first;
    if (!group.needs_reference) EXPECT_TRUE(group.reference_parts.empty()) << first;
  }
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
