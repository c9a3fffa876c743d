// Runs that are killed at random moments go on to the same bytes, with every topic.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "core/random.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/runner/journal/run_file.h"
#include "tests/support/long_tests.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::vector<Topic> topics_and_toys() {
  std::vector<Topic> topics = all_topics();
  for (Topic& topic : toy::topics()) topics.push_back(std::move(topic));
  return topics;
}

/// Of each experiment: 100 of all in long tests, one of each in others.
int kills_asked() {
  constexpr double kLong = 100;
  const double experiments = static_cast<double>(topics_and_toys().size());
  return at_length() ? static_cast<int>(std::ceil(kLong / experiments)) : 1;
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class LongKills : public RunTest, public ::testing::WithParamInterface<std::string> {
 protected:
  /// Starts the experiment of the topic, or goes on with it.
  [[nodiscard]] ProgramProcess program(const fs::path& out) const {
    const std::string file = GEOPRIOR_SOURCE_DIR "/tests/topics/small/" + GetParam() + ".toml";
    std::vector<std::string> words{"run", file, "--no-pictures", "--threads", "1", "--out", out};
    if (fs::exists(out / "journal.jsonl")) words.emplace_back("--resume");
    return {[words] { return run_as_program(words, topics_and_toys()); }, folder() / "log"};
  }

  [[nodiscard]] std::string log() const { return text_of(folder() / "log"); }
};

// The undisturbed run says how long it takes; kills come at any time of that, and a little after.
TEST_P(LongKills, AtAnyMomentLoseNothing) {
  const fs::path undisturbed = folder() / "undisturbed";
  const Clock::time_point start = Clock::now();
  ASSERT_EQ(program(undisturbed).wait(), 0) << log();
  const double whole_s = seconds_since(start);
  const std::string expected = read_run_file(undisturbed / "run.h5").content_sha256;
  int unfinished = 0;
  for (int i = 0; i < kills_asked(); ++i) {
    const fs::path out = folder() / ("killed-" + std::to_string(i));
    RandomStream random(static_cast<std::uint64_t>(i), "kill " + GetParam());
    const double moment_s = 1.1 * whole_s * random.uniform();
    {
      ProgramProcess killed = program(out);
      std::this_thread::sleep_for(std::chrono::duration<double>(moment_s));
      killed.signal(SIGKILL);
      unfinished += killed.wait() == -SIGKILL ? 1 : 0;
    }
    ASSERT_EQ(program(out).wait(), 0) << "kill " << i << " at " << moment_s << " s\n" << log();
    EXPECT_EQ(read_run_file(out / "run.h5").content_sha256, expected)
        << "kill " << i << " at " << moment_s << " s of " << whole_s << " s";
    EXPECT_EQ(lasting_files(out), lasting_files(undisturbed)) << "kill " << i;
    fs::remove_all(out);
  }
  RecordProperty("killed", unfinished);
}

std::vector<std::string> topic_names() {
  std::vector<std::string> names;
  for (const Topic& topic : topics_and_toys()) names.push_back(topic.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Topics, LongKills, ::testing::ValuesIn(topic_names()), [](const auto& i) {
  std::string name = i.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace geoprior::test
