#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace geoprior::test {

/// What a test should cost at most, in s of processor time: 2, and ten times that where the code is
/// not optimised or runs under a sanitizer.
double usual_cost();

/// Says of each test what it costs, notices what costs more than it should, and says where a
/// process is.
///
/// No test fails by it: on a machine that others use, processor time of the same work was seen to
/// triple. A suite's `SetUpTestSuite` counts by itself. Tests named Long… (the suite or the test)
/// may cost what they want while GEOPRIOR_LONG is set.
class CostListener : public ::testing::EmptyTestEventListener {
 public:
  /// @param most       what costs more, in s of processor time of the process and of the children
  ///                   that it waited for, is noticed
  /// @param say_place  gets the name of the test that begins, and of what comes between tests
  CostListener(double most, std::function<void(const std::string&)> say_place);

  void OnTestSuiteStart(const ::testing::TestSuite& suite) override;
  void OnTestStart(const ::testing::TestInfo& test) override;
  void OnTestEnd(const ::testing::TestInfo& test) override;

 private:
  void begin(const std::string& place);
  void end(const std::string& place, bool is_long);

  double most_;
  std::function<void(const std::string&)> say_place_;
  double start_ = 0;
  std::string suite_in_set_up_;
};

/// Of this process and of the children that it waited for, in s.
double processor_seconds();

}  // namespace geoprior::test
