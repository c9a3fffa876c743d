// What happens when the memory does not suffice, or would not.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <new>

#include "core/error.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/program.h"
#include "testbed/runner/execute.h"
#include "testbed/runner/process/peak_memory.h"
#include "testbed/runner/spec/spec.h"
#include "tests/core/allocations.h"
#include "tests/testbed/scratch_folder.h"
#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

std::string first_numbers(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += (i == 0 ? "" : ", ") + std::to_string(i);
  return "[" + text + "]";
}

std::string sweep_of(const std::string& key, int count, const std::string& more = "") {
  return "[[sweep]]\nkey = \"" + key + "\"\nvalues = " + first_numbers(count) + "\n" + more;
}

class Memory : public ::testing::Test {
 protected:
  Experiment load(const std::string& more) {
    const fs::path file =
        home_.write("experiments/toy-circle/disc.toml", toy::disc_experiment() + more);
    return load_experiment(file, toy::topics(), {});
  }
  std::string error_of(const std::string& more) {
    try {
      (void)load(more);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  toy::Home home_;
};

TEST_F(Memory, CasesAreCountedBeforeTheyAreMade) {
  const std::string grid = "grid = true\n";
  const std::string cube = sweep_of("seed", 100, grid) + sweep_of("scene.points", 100, grid) +
                           sweep_of("variant.polygon.options.segments", 100, grid);
  EXPECT_THAT(error_of(cube),
              AllOf(HasSubstr("disc.toml:22:1: sweep.values: asks for 1000001 cases"),
                    HasSubstr("at most 10000")));
  EXPECT_THAT(error_of(sweep_of("seed", 10001)),
              HasSubstr("disc.toml:18:1: sweep.values: asks for 10002 cases"));
  ::setenv("GEOPRIOR_MEMORY_GB", "0.001", 1);
  EXPECT_THAT(error_of(sweep_of("seed", 1000)),
              AllOf(HasSubstr("sweep.values: asks for 1001 cases"), HasSubstr("MB of memory")));
  ::unsetenv("GEOPRIOR_MEMORY_GB");
}

TEST_F(Memory, FramesOfAFigureAreCounted) {
  EXPECT_THAT(error_of("[figure_view]\nparameters = " + first_numbers(101)),
              AllOf(HasSubstr("disc.toml:17:1"), HasSubstr("asks for 101 frames of a figure")));
  EXPECT_THAT(error_of("[figure_view.below]\nparameters = " + first_numbers(101)),
              AllOf(HasSubstr("disc.toml:17:1"), HasSubstr("asks for 101 frames of a figure")));
  EXPECT_THAT(error_of("[figure_view.below]\ntarget = [1, 2]\n"),
              AllOf(HasSubstr("disc.toml:17:1"), HasSubstr("an array of 3 numbers")));
}

// Each case kept a copy of the file with all values: 2.8 GB.
TEST_F(Memory, OfASweepIsInProportionToItsValues) {
  if (!test::allocations_of([] {})) GTEST_SKIP() << "the sanitizers keep what is freed";
  const PeakMemory memory;
  const Experiment experiment = load(sweep_of("seed", 4000));
  EXPECT_EQ(experiment.cases.size(), 4001U);
  if (const auto use = memory.use()) {
    EXPECT_LT(static_cast<double>(use->peak - use->start), 200e6);
  }
}

TEST_F(Memory, FileThatDoesNotFitIsNotReadInPart) {
  const fs::path file = home_.write("large.bin", std::string(1 << 20, 'x'));
  EXPECT_EQ(read_whole_file(file).size(), std::size_t{1} << 20U);
  ::setenv("GEOPRIOR_MEMORY_GB", "0.001", 1);
  test::expect_error([&] { (void)read_whole_file(file); }, {"large.bin", "1.0 MB of memory"});
  ::unsetenv("GEOPRIOR_MEMORY_GB");
}

/// Reads a file where the address space is short; ends with 0 when that is an Error.
[[noreturn]] void read_in_little_space(const fs::path& file) {
  ::setenv("GEOPRIOR_MEMORY_GB", "1000", 1);
  const rlimit limit{1 << 20, 1 << 20};
  ::setrlimit(RLIMIT_AS, &limit);
  try {
    (void)read_whole_file(file);
  } catch (const Error& error) {
    std::fputs(error.what(), stderr);
    std::_Exit(0);
  }
  std::_Exit(1);
}

TEST_F(Memory, ShortOfItAFileIsAnError) {
  if (!test::allocations_of([] {})) GTEST_SKIP() << "the sanitizers need address space";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const fs::path file = home_.write("sparse.bin", "x");
  fs::resize_file(file, std::uintmax_t{1} << 32U);
  EXPECT_EXIT(read_in_little_space(file), ::testing::ExitedWithCode(0), "does not fit into memory");
}

/// The toy whose scene asks for more than there is.
Topic without_memory() {
  Topic topic = toy::circle_topic();
  topic.load = [](const OptionSet&, const fs::path&, std::uint64_t) -> std::shared_ptr<Scene> {
    throw std::bad_alloc();
  };
  return topic;
}

TEST_F(Memory, ShortOfItARunNamesItsCaseAndLeavesNoFolder) {
  const Experiment experiment = load("");
  ExecuteRequest request;
  request.out = fs::path(home_.write("empty/x", "")).parent_path() / "out";
  test::expect_error([&] { (void)execute(experiment, {without_memory()}, request); },
                     {"disc.toml", "case 'default'", "memory"});
  EXPECT_FALSE(fs::exists(*request.out));
}

TEST_F(Memory, ShortOfItAVariantIsNamed) {
  Topic topic = toy::circle_topic();
  for (MethodEntry& method : topic.methods) {
    method.make = [](const Scene&, const OptionSet&, RunContext&) -> MethodEntry::Instance {
      throw std::bad_alloc();
    };
  }
  const Experiment experiment = load("");
  ExecuteRequest request;
  request.out = fs::path(home_.write("empty/x", "")).parent_path() / "out";
  test::expect_error([&] { (void)execute(experiment, {topic}, request); },
                     {"case 'default'", "variant 'exact'", "memory"});
  EXPECT_FALSE(fs::exists(*request.out));
}

TEST_F(Memory, ShortOfItTheProgramIsInNoInternalError) {
  Topic topic = toy::circle_topic();
  topic.default_scene = []() -> std::unique_ptr<OptionSet> { throw std::bad_alloc(); };
  const std::string file =
      home_.write("experiments/toy-circle/disc.toml", toy::disc_experiment()).string();
  const std::array<const char*, 3> arguments{"geoprior", "run", file.c_str()};
  ::testing::internal::CaptureStderr();
  const int code = run_program(3, arguments.data(), {topic});
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(code, 2);
  EXPECT_THAT(said, AllOf(HasSubstr("error: run "), HasSubstr("disc.toml"), HasSubstr("memory"),
                          Not(HasSubstr("internal"))));
}

}  // namespace
}  // namespace geoprior
