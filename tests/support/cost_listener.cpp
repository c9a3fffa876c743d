#include "tests/support/cost_listener.h"

#include <sys/resource.h>
#include <time.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace geoprior::test {
namespace {

#if defined(__SANITIZE_ADDRESS__) || !defined(__OPTIMIZE__)
constexpr double kSlowness = 10;
#else
constexpr double kSlowness = 1;
#endif

constexpr double kShown = 0.1;  ///< what costs less has no line of its own

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// "Long" as its first word: "LongMotion", "Seeds/LongKills", not "LongestEdge".
bool is_named_long(std::string_view name) {
  if (const std::size_t slash = name.find("/Long"); slash != name.npos)
    name.remove_prefix(slash + 1);
  if (!name.starts_with("Long")) return false;
  name.remove_prefix(4);
  return name.empty() || name.front() < 'a' || name.front() > 'z';
}

bool is_long(const ::testing::TestInfo& test) {
  return is_named_long(test.test_suite_name()) || is_named_long(test.name());
}

std::string name_of(const ::testing::TestInfo& test) {
  return std::string(test.test_suite_name()) + "." + test.name();
}

}  // namespace

double usual_cost() { return 2 * kSlowness; }

double processor_seconds() {
  timespec own{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &own);
  rusage children{};
  ::getrusage(RUSAGE_CHILDREN, &children);
  return static_cast<double>(own.tv_sec) + 1e-9 * static_cast<double>(own.tv_nsec) +
         seconds_of(children.ru_utime) + seconds_of(children.ru_stime);
}

CostListener::CostListener(double most, std::function<void(const std::string&)> say_place)
    : most_(most), say_place_(std::move(say_place)) {}

void CostListener::OnTestSuiteStart(const ::testing::TestSuite& suite) {
  suite_in_set_up_ = suite.name();
  begin("the set-up of " + suite_in_set_up_);
}

void CostListener::OnTestStart(const ::testing::TestInfo& test) {
  if (!suite_in_set_up_.empty()) end("the set-up of " + suite_in_set_up_, is_long(test));
  suite_in_set_up_.clear();
  begin(name_of(test));
}

void CostListener::OnTestEnd(const ::testing::TestInfo& test) {
  end(name_of(test), is_long(test));
  begin("what follows " + name_of(test));
}

void CostListener::begin(const std::string& place) {
  say_place_(place);
  start_ = processor_seconds();
}

void CostListener::end(const std::string& place, bool is_long) {
  const double seconds = processor_seconds() - start_;
  if (seconds >= kShown) std::printf("[   COST   ] %s: %.2f s\n", place.c_str(), seconds);
  if (is_long && std::getenv("GEOPRIOR_LONG") != nullptr) return;
  if (seconds > most_)
    std::printf("[  NOTICE  ] %s costs %.2f s of processor time, more than %g s\n", place.c_str(),
                seconds, most_);
}

}  // namespace geoprior::test
