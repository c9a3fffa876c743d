// `geoprior check --jobs`: several experiments at once, each in a process of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/testbed/await.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/toy_home.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using toy::Outcome;

class CheckJobs : public ::testing::Test {
 protected:
  void SetUp() override {
    home_.write("experiments/toy-circle/disc.toml", toy::disc_experiment());
    home_.write("experiments/toy-circle/hexagon.toml",
                toy::disc_experiment("segments = 6", toy::kPlotted));
    write_pendulum("swing", "");
  }
  void write_pendulum(const std::string& name, const std::string& scene) const {
    home_.write("experiments/toy-pendulum/" + name + ".toml",
                "title = \"A pendulum\"\ntopic = \"toy-pendulum\"\n[scene]\n" + scene +
                    "\n[[variant]]\nname = \"exact\"\nmethod = \"closed-form\"\n");
  }
  void bless_all() const {
    for (const char* id : {"toy-circle/disc", "toy-circle/hexagon", "toy-pendulum/swing"}) {
      const Outcome outcome = home_.run(std::string("bless --reason first ") + id);
      ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
  }
  [[nodiscard]] std::size_t runs_of(const std::string& id) const {
    const fs::path folder = home_.root() / "results/runs" / id;
    std::error_code none;
    return std::distance(fs::directory_iterator(folder, none), {});
  }
  /// The program on this folder, as a process that can be sent signals.
  [[nodiscard]] ToyProgram start(const std::vector<std::string>& arguments) const {
    return {arguments, log(), [this] {
              ::setenv("GEOPRIOR_HOME", home_.root().c_str(), 1);
              ::setenv("GEOPRIOR_RUNS", "", 1);
            }};
  }
  [[nodiscard]] fs::path log() const { return home_.root() / "log"; }
  /// Waits until a run of the experiment has a frame.
  void await_frame_of(const std::string& id) const {
    const auto has_frame = [](const fs::path& run) {
      return text_of(run / "journal.jsonl").find("\"kind\":\"frame\"") != std::string::npos;
    };
    const auto any_has_frame = [&] {
      std::error_code none;
      const fs::directory_iterator runs(home_.root() / "results/runs" / id, none);
      return std::any_of(begin(runs), end(runs), has_frame);
    };
    ASSERT_TRUE(await(any_has_frame)) << "no frame of " << id << ": " << text_of(log());
  }
  /// The process, found by its command line, that checks the experiment.
  static pid_t process_of(const std::string& id) {
    for (const auto& entry : fs::directory_iterator("/proc")) {
      std::string words = text_of(entry.path() / "cmdline");
      std::replace(words.begin(), words.end(), '\0', ' ');
      if (words.find("check --json --threads") != std::string::npos &&
          words.ends_with("-- " + id + " ")) {
        return std::stoi(entry.path().filename().string());
      }
    }
    return 0;
  }

  toy::Home home_;
};

TEST_F(CheckJobs, FindTheRunsAndSayWhatOneAfterTheOtherDoes) {
  bless_all();
  const Outcome in_turn = home_.run("check --json");
  ASSERT_EQ(in_turn.code, 0) << in_turn.err;
  const Outcome at_once = home_.run("check --json --jobs 3 --threads 1");
  EXPECT_EQ(at_once.code, 0) << at_once.err;
  EXPECT_EQ(at_once.out, in_turn.out);
  EXPECT_EQ(at_once.err, in_turn.err);
  EXPECT_EQ(runs_of("toy-circle/disc"), 1U) << "a limit of threads is not part of what names a run";
  EXPECT_EQ(home_.run("check --jobs 2 toy-circle/disc toy-circle/disc").code, 0) << "named twice";
  EXPECT_EQ(runs_of("toy-circle/disc"), 1U);
}

TEST_F(CheckJobs, MakeTheRunsThatOthersFind) {
  ASSERT_EQ(home_.run("check --jobs 3 --threads 1").code, 1) << "there is no reference yet";
  bless_all();
  EXPECT_EQ(home_.run("check").code, 0);
  for (const char* id : {"toy-circle/disc", "toy-circle/hexagon", "toy-pendulum/swing"}) {
    EXPECT_EQ(runs_of(id), 1U) << id;
  }
}

TEST_F(CheckJobs, FailWithTheWorstExitCodeAndTheOthersAreCheckedAllTheSame) {
  bless_all();
  home_.write("experiments/toy-circle/hexagon.toml",
              toy::disc_experiment("segments = 7", toy::kPlotted));
  const Outcome changed = home_.run("check --json --jobs 2");
  EXPECT_EQ(changed.code, 1);
  const json verdicts = json::parse(changed.out);
  EXPECT_EQ(verdicts["passed"], false);
  EXPECT_EQ(verdicts["experiments"][0]["passed"], true);
  EXPECT_EQ(verdicts["experiments"][1]["passed"], false);
  EXPECT_EQ(verdicts["experiments"][2]["passed"], true);
  home_.write("experiments/toy-circle/hexagon.toml", toy::disc_experiment("segmets = 7"));
  const Outcome wrong = home_.run("check --json --jobs 2");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, AllOf(HasSubstr("did you mean 'segments'"),
                               HasSubstr("failed  toy-circle/hexagon: it could not be checked"),
                               HasSubstr("ok      toy-pendulum/swing")));
  EXPECT_EQ(json::parse(wrong.out)["experiments"][1]["experiment"], "toy-circle/hexagon");
  const Outcome unknown = home_.run("check --jobs 2 toy-circle/disc toy-circle/disk");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, AllOf(HasSubstr("did you mean"), Not(HasSubstr("ok"))));
  for (const char* bad : {"check --jobs 0", "check --jobs many", "check --threads -1"}) {
    EXPECT_EQ(home_.run(bad).code, 2) << bad;
  }
}

TEST_F(CheckJobs, OneThatIsKilledIsNamedAndFails) {
  write_pendulum("killed", "frames = 10000\nframe_delay_ms = 50");
  ToyProgram program = start({"check", "--jobs", "2", "toy-pendulum/killed", "toy-circle/disc"});
  await_frame_of("toy-pendulum/killed");
  const pid_t child = process_of("toy-pendulum/killed");
  ASSERT_GT(child, 0);
  ::kill(child, SIGKILL);
  EXPECT_EQ(program.wait(), 3) << text_of(log());
  EXPECT_THAT(text_of(log()),
              AllOf(HasSubstr("failed  toy-pendulum/killed: the process that checked it was ended "
                              "by signal 9"),
                    HasSubstr("failed  toy-circle/disc")));
}

TEST_F(CheckJobs, StopAtCtrlCAndGoOnWhenTheyAreCheckedAgain) {
  write_pendulum("slow", "frames = 20\nframe_delay_ms = 50");
  write_pendulum("slower", "frames = 20\nframe_delay_ms = 51");
  const std::vector<std::string> check{"check", "--jobs", "2", "toy-pendulum/slow",
                                       "toy-pendulum/slower"};
  ToyProgram program = start(check);
  await_frame_of("toy-pendulum/slow");
  await_frame_of("toy-pendulum/slower");
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(), 2) << text_of(log());
  EXPECT_THAT(text_of(log()), HasSubstr("stopped"));
  EXPECT_EQ(process_of("toy-pendulum/slow") + process_of("toy-pendulum/slower"), 0);
  ToyProgram again = start(check);
  EXPECT_EQ(again.wait(), 1) << text_of(log()) << "there is no reference";
  EXPECT_EQ(runs_of("toy-pendulum/slow"), 1U) << "the run was gone on with";
  EXPECT_EQ(runs_of("toy-pendulum/slower"), 1U);
}

TEST_F(CheckJobs, EndWithTheProgramThatStartedThem) {
  write_pendulum("orphan", "frames = 10000\nframe_delay_ms = 50");
  ToyProgram program = start({"check", "--jobs", "2", "toy-pendulum/orphan", "toy-circle/disc"});
  await_frame_of("toy-pendulum/orphan");
  program.signal(SIGKILL);
  EXPECT_EQ(program.wait(), -SIGKILL);
  EXPECT_TRUE(await([] { return process_of("toy-pendulum/orphan") == 0; }));
}

TEST_F(CheckJobs, ThatNeedTheSameInputMakeItOnce) {
  write_pendulum("swing", "frames = 10\nframe_delay_ms = 20");
  const std::string input = "input = \"run:toy-pendulum/swing/exact\"";
  write_pendulum("one", input);
  write_pendulum("two", input + "\nframes = 3");
  const Outcome outcome = home_.run("check --jobs 2 toy-pendulum/one toy-pendulum/two");
  EXPECT_EQ(outcome.code, 1) << "there is no reference";
  EXPECT_THAT(outcome.err, Not(HasSubstr("error")));
  EXPECT_EQ(runs_of("toy-pendulum/swing"), 1U);
  EXPECT_EQ(runs_of("toy-pendulum/one") + runs_of("toy-pendulum/two"), 2U);
}

TEST_F(CheckJobs, MakeAnInputOnceThatIsCheckedItself) {
  write_pendulum("swing", "frames = 10\nframe_delay_ms = 20");
  write_pendulum("needy", "input = \"run:toy-pendulum/swing/exact\"");
  (void)home_.run("check --jobs 2 toy-pendulum/swing toy-pendulum/needy");
  EXPECT_EQ(runs_of("toy-pendulum/swing"), 1U) << "at the same time";
  EXPECT_EQ(home_.run("check --json").code, 1) << "there is no reference";
  EXPECT_EQ(runs_of("toy-pendulum/swing"), 1U) << "nor again";
  fs::remove_all(home_.root() / "results/runs/toy-pendulum/needy");
  EXPECT_EQ(home_.run("check toy-pendulum/swing toy-pendulum/needy").code, 1);
  EXPECT_EQ(runs_of("toy-pendulum/swing"), 1U) << "nor one after the other";
}

}  // namespace
}  // namespace geoprior::test
