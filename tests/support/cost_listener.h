#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace geoprior::test {

/// Seconds of processor time, of the process and of the children that it waited for.
struct CostLimits {
  double notice;
  double failure;
};

/// What a test may cost: 2 s, and 6 s at the latest; ten times that where the code is not
/// optimised or runs under a sanitizer.
CostLimits default_cost_limits();

/// Fails a test that costs too much and says where a process is.
///
/// Processor time, not the clock: a busy machine changes it little. A suite's `SetUpTestSuite` is
/// held to the same limits, as part of its first test. Tests named Long… (the suite or the test)
/// may cost what they want while GEOPRIOR_LONG is set.
class CostListener : public ::testing::EmptyTestEventListener {
 public:
  /// @param say_place  gets the name of the test that begins, and of what comes between tests
  CostListener(CostLimits limits, std::function<void(const std::string&)> say_place);

  void OnTestSuiteStart(const ::testing::TestSuite& suite) override;
  void OnTestStart(const ::testing::TestInfo& test) override;
  void OnTestEnd(const ::testing::TestInfo& test) override;

 private:
  void begin(const std::string& place);
  void end(const std::string& place, bool is_long);

  CostLimits limits_;
  std::function<void(const std::string&)> say_place_;
  double start_ = 0;
  std::string suite_in_set_up_;
};

/// Of this process and of the children that it waited for, in s.
double processor_seconds();

}  // namespace geoprior::test
