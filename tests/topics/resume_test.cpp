// Runs that are killed at random moments go on to the same bytes, with every topic.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <thread>
#include <tuple>

#include "core/random.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/runner/journal/run_file.h"
#include "tests/support/long_tests.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;

std::vector<Topic> topics_and_toys() {
  std::vector<Topic> topics = all_topics();
  for (Topic& topic : toy::topics()) topics.push_back(std::move(topic));
  return topics;
}

/// Tests of each experiment, so that all together are more than 20 kills; and the kills of each.
constexpr int kTests = 3;
int kills_asked() {
  constexpr double kLong = 100;
  const double tests = kTests * static_cast<double>(topics_and_toys().size());
  return at_length() ? static_cast<int>(std::ceil(kLong / tests)) : 1;
}

/// Waits until a program has used some processor time, or has ended: how fast it is on a busy
/// machine does not matter. Returns what it has used.
double wait_until_used(ProgramProcess& program, double seconds) {
  double used = 0;
  while (used < seconds && !program.poll()) {
    used = std::max(used, program.processor_seconds());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return used;
}

class LongKills : public RunTest,
                  public ::testing::WithParamInterface<std::tuple<std::string, int>> {
 protected:
  /// Starts the experiment of the topic, or goes on with it.
  [[nodiscard]] ProgramProcess program(const fs::path& out) const {
    const std::string file = GEOPRIOR_SOURCE_DIR "/tests/topics/small/" + topic() + ".toml";
    std::vector<std::string> words{"run", file, "--no-pictures", "--threads", "1", "--out", out};
    if (fs::exists(out / "journal.jsonl")) words.emplace_back("--resume");
    return {[words] { return run_as_program(words, topics_and_toys()); }, folder() / "log"};
  }

  [[nodiscard]] static std::string topic() { return std::get<0>(GetParam()); }
  [[nodiscard]] std::string log() const { return text_of(folder() / "log"); }
};

// The undisturbed run says how much processor time it takes; kills come at any time of that. Those
// count that hit a program at work.
TEST_P(LongKills, AtAnyMomentLoseNothing) {
  constexpr double kMore = std::numeric_limits<double>::infinity();
  const fs::path undisturbed = folder() / "undisturbed";
  ProgramProcess whole = program(undisturbed);
  const double whole_s = wait_until_used(whole, kMore);
  ASSERT_EQ(whole.wait(), 0) << log();
  const std::string expected = read_run_file(undisturbed / "run.h5").content_sha256;
  int killed = 0;
  for (int i = 0; killed < kills_asked(); ++i) {
    ASSERT_LT(i, 10 * kills_asked()) << "only " << killed << " kills met a program at work";
    const fs::path out = folder() / ("killed-" + std::to_string(i));
    RandomStream random(static_cast<std::uint64_t>(i),
                        "kill " + topic() + std::to_string(std::get<1>(GetParam())));
    const double moment_s = whole_s * random.uniform();
    {
      ProgramProcess victim = program(out);
      wait_until_used(victim, moment_s);
      victim.signal(SIGKILL);
      killed += victim.wait() == -SIGKILL ? 1 : 0;
    }
    ASSERT_EQ(program(out).wait(), 0) << "kill " << i << " at " << moment_s << " s\n" << log();
    EXPECT_EQ(read_run_file(out / "run.h5").content_sha256, expected)
        << "kill " << i << " at " << moment_s << " s of " << whole_s << " s";
    EXPECT_EQ(lasting_files(out), lasting_files(undisturbed)) << "kill " << i;
    fs::remove_all(out);
  }
  RecordProperty("killed", killed);
}

std::vector<std::string> topic_names() {
  std::vector<std::string> names;
  for (const Topic& topic : topics_and_toys()) names.push_back(topic.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Topics, LongKills,
                         ::testing::Combine(::testing::ValuesIn(topic_names()),
                                            ::testing::Range(0, kTests)),
                         [](const auto& i) {
                           std::string name = std::get<0>(i.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name + std::to_string(std::get<1>(i.param));
                         });

}  // namespace
}  // namespace geoprior::test
