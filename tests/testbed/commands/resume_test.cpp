// Interrupted runs end as undisturbed ones do: same files, same content_sha256.

#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <thread>

#include "core/error.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/runner/journal/journal.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/spec/spec.h"
#include "tests/testbed/await.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

std::size_t count_lines(const fs::path& journal, const std::string& kind) {
  const std::string text = text_of(journal);
  std::size_t count = 0;
  const std::string wanted = "\"kind\":\"" + kind + "\"";
  for (std::size_t at = 0; (at = text.find(wanted, at)) != std::string::npos; ++at) ++count;
  return count;
}

class Resume : public RunTest {
 protected:
  [[nodiscard]] fs::path out() const { return folder() / "an out's folder"; }
  [[nodiscard]] fs::path log() const { return folder() / "log"; }
  [[nodiscard]] fs::path journal() const { return out() / "journal.jsonl"; }

  /// Starts the run as a program and sends it a signal once `frames` frames are logged.
  int interrupt(const fs::path& file, std::size_t frames, int number) {
    std::vector<std::string> command{"run", file.string(), "--no-pictures", "--out",
                                     out().string()};
    if (fs::exists(journal())) command.emplace_back("--resume");
    ToyProgram program(command, log());
    if (!await([&] { return count_lines(journal(), "frame") >= frames; }))
      throw Error("no frames: " + text_of(log()));
    program.signal(number);
    return program.wait();
  }

  void expect_equal_to_undisturbed(const fs::path& file) {
    const ExecuteResult resumed = run(load(file), out(), true);
    ASSERT_FALSE(resumed.stopped);
    const ExecuteResult undisturbed = run(load(file), folder() / "undisturbed");
    EXPECT_EQ(resumed.record.content_sha256, undisturbed.record.content_sha256);
    EXPECT_EQ(lasting_files(out()), lasting_files(undisturbed.folder));
    EXPECT_EQ(read_run_file(out() / "run.h5").content_sha256, undisturbed.record.content_sha256);
  }
};

TEST_F(Resume, AfterKillsOfAProcessWithCheckpoints) {
  const auto file = pendulum("frames = 6\nframe_delay_ms = 50");
  for (const std::size_t frames : {2U, 5U, 9U, 16U}) {
    ASSERT_EQ(interrupt(file, frames, SIGKILL), -SIGKILL) << text_of(log());
    EXPECT_FALSE(fs::exists(out() / "run.h5"));
  }
  const std::size_t before = count_lines(journal(), "frame");
  expect_equal_to_undisturbed(file);
  // 3 variants of 7 frames; a kill costs at most the frames after the last checkpoint: one here,
  // logged but not yet covered by a checkpoint.
  EXPECT_GE(before, 16U);
  EXPECT_LE(count_lines(journal(), "frame"), 21U + 4U);
}

// Every frame waits 50 ms: a frame made before the kill keeps the time that the journal has, one
// made after it has a time of its own, and none has that of another.
TEST_F(Resume, KeepsTheTimesOfTheFramesBeforeTheKill) {
  const auto file = pendulum("frames = 6\nframe_delay_ms = 50");
  ASSERT_EQ(interrupt(file, 4, SIGKILL), -SIGKILL) << text_of(log());
  std::vector<double> before;
  {
    const Journal log_of_run(journal());
    for (const journal::Line& line : log_of_run.lines()) {
      const auto* frame = std::get_if<journal::FrameLine>(&line);
      if (frame != nullptr) before.push_back(frame->timing.at("run"));
    }
  }
  const auto begin = std::chrono::steady_clock::now();
  const ExecuteResult resumed = run(load(file), out(), true);
  const double lasted =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto& timing = resumed.record.cases.front().variants.front().timing.at("run");
  ASSERT_EQ(timing.size(), 7U);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_GE(timing[i].front(), 0.05) << i;
    // The last frame of the journal may lack its checkpoint: it is made again.
    if (i + 1 < before.size()) {
      EXPECT_EQ(timing[i].front(), before[i]) << i;
    }
    if (i >= before.size()) {
      EXPECT_LT(timing[i].front(), lasted) << i;
    }
  }
  EXPECT_EQ(count_lines(journal(), "resume"), 1U);
}

TEST_F(Resume, AfterKillsOfAProcessWithoutCheckpoints) {
  const auto file = pendulum("frames = 4\nframe_delay_ms = 50", "checkpoints = false");
  ASSERT_EQ(interrupt(file, 3, SIGKILL), -SIGKILL) << text_of(log());
  // Frames of the broken variant are made again, those of finished variants are not.
  ASSERT_EQ(interrupt(file, 3 + 7, SIGKILL), -SIGKILL) << text_of(log());
  expect_equal_to_undisturbed(file);
}

TEST_F(Resume, AfterAKillOfPosesGoesOnAtTheNextFrame) {
  const auto file = circle("motion = { frames = 60 }\npoints = 3000");
  ASSERT_EQ(interrupt(file, 20, SIGKILL), -SIGKILL) << text_of(log());
  expect_equal_to_undisturbed(file);
  EXPECT_EQ(count_lines(journal(), "frame"), 120U);  // none twice
}

double processor_seconds_in(const fs::path& run_folder) {
  return std::stod(read_run_file(run_folder / "run.h5").provenance.at("processor_s"));
}

TEST_F(Resume, AddsUpProcessorTimeOverThePrograms) {
  const auto file = pendulum("frames = 6\nframe_delay_ms = 50");
  ASSERT_GT(interrupt(file, 3, SIGINT), 0) << text_of(log());
  double first = 0;
  {
    const Journal log_of_run(journal());
    for (const journal::Line& line : log_of_run.lines()) {
      if (const auto* of_case = std::get_if<journal::ProcessorLine>(&line))
        first += of_case->seconds;
    }
  }
  EXPECT_GT(first, 0);
  run(load(file), out(), true);
  EXPECT_GT(processor_seconds_in(out()), first);
}

TEST_F(Resume, AfterCtrlC) {
  const auto file = pendulum("frames = 6\nframe_delay_ms = 50");
  EXPECT_GT(interrupt(file, 3, SIGINT), 0) << text_of(log());  // left by itself, not done
  // The command is told as a shell reads it.
  EXPECT_THAT(text_of(log()), HasSubstr(" --no-pictures --out '" + folder().string() +
                                        R"(/an out'\''s folder' --resume)"));
  EXPECT_FALSE(fs::exists(out() / "run.h5"));
  expect_equal_to_undisturbed(file);
}

TEST_F(Resume, AfterAStopBeforeTheFirstFrame) {
  const auto file = pendulum();
  request_stop();
  EXPECT_TRUE(run(load(file), out()).stopped);
  clear_stop();
  expect_equal_to_undisturbed(file);
}

TEST_F(Resume, IgnoresATornLastLine) {
  const auto file = pendulum("frames = 6\nframe_delay_ms = 50");
  interrupt(file, 10, SIGKILL);
  std::ofstream(journal(), std::ios::app) << R"({"kind":"frame","case":"def)";
  expect_equal_to_undisturbed(file);
}

TEST_F(Resume, RemovesWhatAKilledProgramLeftHalfWritten) {
  const auto file = pendulum("frames = 6\nframe_delay_ms = 50");
  interrupt(file, 10, SIGKILL);
  std::ofstream(out() / "frames/default/euler/bob_0005.vtp.geoprior-tmp") << "half";
  expect_equal_to_undisturbed(file);
}

TEST_F(Resume, NamesADamagedLineThatIsNotTheLast) {
  const auto file = pendulum("frames = 6\nframe_delay_ms = 50");
  interrupt(file, 5, SIGKILL);
  std::string text = text_of(journal());
  text[text.find('\n') + 3] = '}';
  std::ofstream(journal()) << text;
  EXPECT_THAT(error_of([&] { run(load(file), out(), true); }), HasSubstr("journal.jsonl:2"));
}

TEST_F(Resume, OfAFinishedRunDoesNothing) {
  const auto file = circle();
  const ExecuteResult first = run(load(file), out());
  const auto written = fs::last_write_time(out() / "run.h5");
  const ExecuteResult again = run(load(file), out(), true);
  EXPECT_TRUE(again.was_finished);
  EXPECT_EQ(again.record.content_sha256, first.record.content_sha256);
  EXPECT_EQ(fs::last_write_time(out() / "run.h5"), written);
}

// Of a finished run every frame and artifact is what the journal says, or nothing is said of it.
TEST_F(Resume, OfAFinishedRunWithOtherFramesIsRefused) {
  const auto file = circle();
  const fs::path frames = out() / "frames";
  run(load(file), out());
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(frames)) {
    if (entry.path().extension() == ".vtp") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  ASSERT_GE(files.size(), 2U);
  const fs::path aside = folder() / "aside";
  const auto refusal = [&] { return error_of([&] { run(load(file), out(), true); }); };

  fs::rename(files[0], aside);  // two frames swapped
  fs::rename(files[1], files[0]);
  fs::rename(aside, files[1]);
  EXPECT_THAT(refusal(), AllOf(HasSubstr(files[0].filename().string()),
                               HasSubstr("its SHA-256 is not the recorded one")));
  EXPECT_EQ(ToyProgram({"report", out().string()}, log()).wait(), 2);
  EXPECT_THAT(text_of(log()), HasSubstr("its SHA-256 is not the recorded one"));
  fs::rename(files[1], aside);
  fs::rename(files[0], files[1]);
  fs::rename(aside, files[0]);
  EXPECT_TRUE(run(load(file), out(), true).was_finished);

  fs::rename(files[1], aside);  // one is gone
  EXPECT_THAT(refusal(), HasSubstr(files[1].filename().string()));
  fs::rename(aside, files[1]);

  fs::rename(frames, folder() / "elsewhere");  // a link in place of a folder
  fs::create_directory_symlink(folder() / "elsewhere", frames);
  EXPECT_THAT(refusal(), HasSubstr("link"));
}

// A terminal that is closed leaves a run that goes on; under nohup it does not matter.
TEST_F(Resume, AfterAClosedTerminal) {
  const auto file = pendulum("frames = 6\nframe_delay_ms = 50");
  EXPECT_EQ(interrupt(file, 3, SIGHUP), 2) << text_of(log());
  EXPECT_THAT(text_of(log()), HasSubstr("--resume"));
  expect_equal_to_undisturbed(file);
}

TEST_F(Resume, IsNotNeededAfterAClosedTerminalUnderNohup) {
  const auto file = pendulum("frames = 3\nframe_delay_ms = 50");
  ::signal(SIGHUP, SIG_IGN);
  EXPECT_EQ(interrupt(file, 2, SIGHUP), 0) << text_of(log());
  ::signal(SIGHUP, SIG_DFL);
}

TEST_F(Resume, AssemblesADamagedRunFileAgain) {
  const auto file = circle();
  const ExecuteResult first = run(load(file), out());
  fs::resize_file(out() / "run.h5", fs::file_size(out() / "run.h5") / 2);
  const ExecuteResult again = run(load(file), out(), true);
  EXPECT_FALSE(again.was_finished);
  EXPECT_EQ(read_run_file(out() / "run.h5").content_sha256, first.record.content_sha256);
  EXPECT_EQ(count_lines(journal(), "frame"), 8U);
}

TEST_F(Resume, OfAnotherSpecificationIsRefused) {
  const auto file = pendulum("frames = 6\nframe_delay_ms = 50");
  interrupt(file, 3, SIGKILL);
  LoadRequest other;
  other.sets = {"scene.length_m=2"};
  EXPECT_THAT(error_of([&] { run(load(file, other), out(), true); }),
              HasSubstr("another specification"));
  const auto finished = circle();
  run(load(finished), folder() / "finished");
  LoadRequest larger;
  larger.sets = {"scene.radius_m=2"};
  EXPECT_THAT(error_of([&] { run(load(finished, larger), folder() / "finished", true); }),
              HasSubstr("another specification"));
}

TEST_F(Resume, OfAFolderThatIsNoRunIsRefused) {
  fs::create_directories(out());
  std::ofstream(out() / "precious") << "data";
  EXPECT_THAT(error_of([&] { run(load(circle()), out(), true); }), HasSubstr("journal.jsonl"));
}

TEST_F(Resume, OfNothingIsRefusedAndMakesNoFolder) {
  const auto file = circle();
  EXPECT_THAT(error_of([&] { run(load(file), out(), true); }), HasSubstr("no run that could be"));
  EXPECT_FALSE(fs::exists(out()));
  ExecuteRequest request;
  request.resume = true;
  EXPECT_THAT(error_of([&] { execute(load(file), toy::topics(), request); }),
              HasSubstr("there is no run of 'toy-circle/disc'"));
  ToyProgram program({"run", file.string(), "--no-pictures", "--out", out().string(), "--resume"},
                     log());
  EXPECT_EQ(program.wait(), 2) << text_of(log());
}

TEST_F(Resume, TwoProgramsNeverWriteOneRun) {
  const auto file = pendulum("frames = 40\nframe_delay_ms = 50");
  ToyProgram program({"run", file.string(), "--no-pictures", "--out", out().string()}, log());
  while (count_lines(journal(), "frame") < 1) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_THAT(error_of([&] { run(load(file), out(), true); }), HasSubstr("another program"));
  program.signal(SIGKILL);
  EXPECT_EQ(program.wait(), -SIGKILL);
}

}  // namespace
}  // namespace geoprior::test
