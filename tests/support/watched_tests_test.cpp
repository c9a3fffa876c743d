#include "tests/support/watched_tests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <string>

#include "testbed/formats/atomic_file.h"
#include "tests/testbed/program_process.h"
#include "tests/testbed/scratch_folder.h"

// The tests of sample_tests.cpp end badly, each in its way: none may pass for one that passed.

namespace geoprior::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Outcome {
  int code = 0;
  std::string text;  ///< of both streams
};

class WatchedTests : public ScratchFolder {
 protected:
  /// The test executable of the samples, on these of them.
  Outcome run(const std::string& filter, bool at_length = false) {
    const std::filesystem::path log = folder() / "log";
    ProgramProcess process(
        [&] {
          at_length ? ::setenv("GEOPRIOR_LONG", "1", 1) : ::unsetenv("GEOPRIOR_LONG");
          return become_program(GEOPRIOR_SAMPLE_TESTS, {"--gtest_filter=" + filter});
        },
        log);
    const int code = process.wait();
    return {code, read_whole_file(log)};
  }
};

TEST_F(WatchedTests, PassWhereAllIsWell) {
  const Outcome outcome = run("Sample.Passes*");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, Not(HasSubstr("FAILED")));
  EXPECT_THAT(outcome.text, HasSubstr("all of it"));
}

// A test that failed by its cost would fail by the machine.
TEST_F(WatchedTests, AreNoticedWhereTheyCostMuchAndPass) {
  for (const char* name : {"Sample.CostsTooMuch", "Sample.LongestCostsTooMuch",
                           "Sample.ChildCostsTooMuch", "the set-up of SampleFixture"}) {
    const std::string text = name;
    const Outcome outcome = run(text.starts_with("the") ? "SampleFixture.IsCheap" : text, true);
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_THAT(outcome.text, HasSubstr("[  NOTICE  ] " + text + " costs "));
    EXPECT_THAT(outcome.text, HasSubstr("s of processor time, more than 0.1 s"));
  }
}

TEST_F(WatchedTests, NamedLongMayCostMuchWhereThatIsAskedFor) {
  EXPECT_THAT(run("Sample.LongCostsTooMuch", true).text, Not(HasSubstr("NOTICE")));
  EXPECT_THAT(run("Sample.LongCostsTooMuch", false).text, HasSubstr("NOTICE"));
}

TEST_F(WatchedTests, AreNamedByTheSignalThatEndsThem) {
  const auto expect = [&](const std::string& name, const std::string& end) {
    const Outcome outcome = run(name + ":Sample.Passes");
    EXPECT_NE(outcome.code, 0) << outcome.text;
    EXPECT_THAT(outcome.text, HasSubstr("FAILED  ] " + end));
  };
  expect("Sample.Faults", "Sample.Faults: ");  // a sanitizer reports the signal itself, and exits
  expect("Sample.Aborts", "Sample.Aborts: ended by signal 6");
  expect("Sample.Terminates", "Sample.Terminates: ended by signal 6");
  expect("Sample.IsKilled", "Sample.IsKilled: ended by signal 9");
  expect("BrokenFixture.*", "the set-up of BrokenFixture: ended by signal 6");
}

TEST_F(WatchedTests, FailWhereOneEndsTheProcessInOrder) {
  for (const char* name : {"Sample.Exits", "Sample.ExitsAtOnce"}) {
    const Outcome outcome = run(std::string(name) + ":Sample.Passes");
    EXPECT_EQ(outcome.code, 1) << outcome.text;
    EXPECT_THAT(outcome.text,
                HasSubstr(std::string("FAILED  ] ") + name + ": the process ended there"));
  }
}

}  // namespace
}  // namespace geoprior::test
