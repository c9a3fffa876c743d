// Tests that end badly, for the tests of what watches them (watched_tests_test.cpp).
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <exception>

#include "tests/support/watched_tests.h"

namespace geoprior::test {
namespace {

void burn(double seconds) {
  const double start = processor_seconds();
  while (processor_seconds() < start + seconds) {
  }
}

TEST(Sample, Passes) {}
TEST(Sample, CostsTooMuch) { burn(0.15); }
TEST(Sample, LongCostsTooMuch) { burn(0.15); }
TEST(Sample, LongestCostsTooMuch) { burn(0.15); }
TEST(Sample, ChildCostsTooMuch) {
  EXPECT_EXIT((burn(0.15), ::_exit(0)), ::testing::ExitedWithCode(0), "");
}
TEST(Sample, PassesADeathTestOfEitherStyle) {
  for (const char* style : {"fast", "threadsafe"}) {
    GTEST_FLAG_SET(death_test_style, style);
    EXPECT_EXIT(::_exit(3), ::testing::ExitedWithCode(3), "");
    EXPECT_EXIT(::raise(SIGKILL), ::testing::KilledBySignal(SIGKILL), "");
  }
}
TEST(Sample, Faults) { ::raise(SIGSEGV); }
TEST(Sample, Aborts) { ::abort(); }
TEST(Sample, Terminates) { std::terminate(); }
TEST(Sample, IsKilled) { ::kill(::getpid(), SIGKILL); }
TEST(Sample, Exits) { ::exit(0); }
TEST(Sample, ExitsAtOnce) { ::_exit(0); }

class SampleFixture : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { burn(0.15); }
};
TEST_F(SampleFixture, IsCheap) {}

class BrokenFixture : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { ::abort(); }
};
TEST_F(BrokenFixture, IsNotReached) {}

}  // namespace
}  // namespace geoprior::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  return geoprior::test::run_watched_tests(0.1);
}
