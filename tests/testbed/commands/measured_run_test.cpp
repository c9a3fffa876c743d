// Metrics computed again from recorded frames: `geoprior measure`.
#include "testbed/runner/judgement/measured_run.h"

#include <gmock/gmock.h>
#include <signal.h>

#include <fstream>

#include "core/error.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/metric_rows.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/run_folder.h"
#include "testbed/runner/spec/spec.h"
#include "tests/testbed/await.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/toy_home.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The toy topics with a metric of a frame and one of the sequence more, and no method that runs.
std::vector<Topic> topics_of_a_later_program() {
  std::vector<Topic> topics = toy::topics();
  for (Topic& topic : topics) {
    topic.metrics.push_back(
        frame_metrics<Scene>([](const Scene&, const Frame& frame) {
          return frame.parameter;
        }).row("parameter_again", "1", "the frame's parameter", Direction::none, {}));
    topic.metrics.push_back(
        sequence_metrics<Scene>([](const Scene&, const FrameSequence& frames) {
          return static_cast<double>(frames.size() + 100 * frames.events().size());
        }).row("frames_and_events", "1", "how many there are", Direction::none, {}));
    for (MethodEntry& method : topic.methods) {
      method.make = [](const Scene&, const OptionSet&, RunContext&) -> MethodEntry::Instance {
        throw Error("a method was made");
      };
    }
  }
  return topics;
}

class Measured : public RunTest {
 protected:
  [[nodiscard]] fs::path out() const { return folder() / "run"; }
  /// Runs the experiment and measures it again by a program with these topics.
  RunRecord run_and_measure(const fs::path& file, const std::vector<Topic>& topics,
                            const LoadRequest& request = {}) {
    before_ = run(load(file, request), out()).record;
    return measure_again(OpenedRun(out()), topics).record;
  }
  [[nodiscard]] const RunRecord& before() const { return before_; }
  [[nodiscard]] fs::path sweep() const {
    const fs::path file = circle("motion = { frames = 4 }");
    std::ofstream(file, std::ios::app)
        << "[[sweep]]\nkey = \"variant.polygon.options.segments\"\nvalues = [4, 8, 16]\n"
           "quick_values = [5, 10]\n[[study]]\nname = \"order\"\nkind = \"exponent\"\n"
           "variant = \"polygon\"\nquantity = \"radius_error\"\n"
           "against = \"variant.polygon.options.segments\"\n"
           "[[claim]]\ntext = \"fast\"\nmetric = \"timing:solve\"\nvariant = \"polygon\"\n"
           "value = 1000\n";
    return file;
  }

 private:
  RunRecord before_;
};

void expect_same_content(const RunRecord& measured, const RunRecord& before) {
  EXPECT_EQ(measured.metrics_sha256, before.metrics_sha256);
  EXPECT_EQ(measured.frames_sha256, before.frames_sha256);
  EXPECT_EQ(measured.content_sha256, before.content_sha256);
}

TEST_F(Measured, ByAnUnchangedProgramIsTheSame) {
  expect_same_content(run_and_measure(pendulum(), toy::topics()), before());
}

TEST_F(Measured, ByAnUnchangedProgramIsTheSameOfSweepsStudiesAndClaimsAboutTime) {
  const RunRecord measured = run_and_measure(sweep(), toy::topics());
  expect_same_content(measured, before());
  ASSERT_EQ(measured.studies.size(), 1U);
  EXPECT_EQ(measured.studies[0].value, before().studies[0].value);
  ASSERT_EQ(measured.claims.size(), before().claims.size());
  EXPECT_EQ(measured.claims[0].left, before().claims[0].left) << "times are kept";
  EXPECT_EQ(measured.cases[0].variants[0].timing, before().cases[0].variants[0].timing);
}

TEST_F(Measured, ByAnUnchangedProgramIsTheSameOfQuickRunsWithOptionsSet) {
  LoadRequest request;
  request.quick = true;
  request.sets = {"scene.radius_m=0.5"};
  request.threads = 1;
  expect_same_content(run_and_measure(sweep(), toy::topics(), request), before());
}

TEST_F(Measured, ByAnUnchangedProgramIsTheSameOfAVariantThatFailed) {
  const fs::path file = pendulum("frames = 4\nduration_s = 1", "fail_at_s = 0.5");
  const RunRecord measured = run_and_measure(file, toy::topics());
  EXPECT_EQ(before().cases[0].variants[1].status, "failed");
  expect_same_content(measured, before());
}

TEST_F(Measured, GetsTheMetricsOfALaterProgramWithoutRunningAMethod) {
  const RunRecord measured = run_and_measure(pendulum(), topics_of_a_later_program());
  EXPECT_EQ(measured.frames_sha256, before().frames_sha256);
  EXPECT_NE(measured.metrics_sha256, before().metrics_sha256);
  const MetricChanges changes = metric_changes(before(), measured);
  EXPECT_THAT(changes.added, ElementsAre("frames_and_events", "parameter_again"));
  EXPECT_THAT(changes.changed, IsEmpty());
  EXPECT_THAT(changes.gone, IsEmpty());
  const VariantRecord& variant = measured.cases[0].variants[0];
  ASSERT_EQ(variant.metrics.at("parameter_again").values.size(), variant.frames.size());
  EXPECT_EQ(variant.metrics.at("parameter_again").values[3], variant.frames[3].parameter);
  EXPECT_EQ(variant.summary.at("frames_and_events").value,
            static_cast<double>(variant.frames.size() + 100 * variant.events.size()));
  EXPECT_EQ(variant.summary.at("parameter_again.max").unit, "1");
  EXPECT_EQ(measured.provenance.at("measured_from"), before().content_sha256);
  EXPECT_EQ(measured.provenance.at("git_commit"), before().provenance.at("git_commit"));
}

TEST_F(Measured, IsARunOfItsOwnThatIsNotTakenForOneOfTheProgram) {
  const fs::path file = pendulum();
  const ExecuteResult original = execute(load(file), toy::topics(), {});
  const auto files = lasting_files(original.folder);
  const OpenedRun opened(original.folder);
  const MeasuredRun measured = measure_again(opened, topics_of_a_later_program());
  const fs::path written = write_measured_run(measured, opened, std::nullopt);
  EXPECT_EQ(written.parent_path(), original.folder.parent_path());
  EXPECT_EQ(find_run(load(file)), original.folder);
  EXPECT_EQ(lasting_files(original.folder), files);
  EXPECT_EQ(OpenedRun(original.folder).record().content_sha256, original.record.content_sha256);
  EXPECT_EQ(find_run_of_content("toy-pendulum/swing", original.record.content_sha256),
            original.folder);
  // Its files are its own: the run that was measured may go.
  fs::remove_all(original.folder);
  require_recorded_files(OpenedRun(written));
  EXPECT_EQ(lasting_files(written), files);
  EXPECT_EQ(find_run(load(file)), std::nullopt);
  EXPECT_THAT(error_of([&] { (void)run(load(file), written, true); }),
              HasSubstr("another specification"));
}

TEST_F(Measured, OfDamagedFramesIsRefused) {
  (void)run(load(pendulum()), out());
  const fs::path frame = out() / "frames/default/exact/bob_0002.vtp";
  std::ofstream(frame, std::ios::app) << " ";
  EXPECT_THAT(error_of([&] { (void)measure_again(OpenedRun(out()), toy::topics()); }),
              AllOf(HasSubstr(frame.string()), HasSubstr("damaged")));
}

TEST_F(Measured, NeedsTheRunsThatWereItsInputs) {
  (void)pendulum();
  const fs::path file =
      write_experiment("toy-pendulum/needy",
                       "title = \"n\"\ntopic = \"toy-pendulum\"\n[scene]\n"
                       "input = \"run:toy-pendulum/swing/exact\"\n[[variant]]\nname = \"v\"\n"
                       "method = \"closed-form\"\n");
  expect_same_content(run_and_measure(file, toy::topics()), before());
  fs::remove_all(folder() / "runs/toy-pendulum/swing");
  EXPECT_THAT(error_of([&] { (void)measure_again(OpenedRun(out()), toy::topics()); }),
              AllOf(HasSubstr("scene of case 'default'"), HasSubstr("toy-pendulum/swing"),
                    HasSubstr("no longer there")));
}

TEST_F(Measured, ByAProgramWithoutItsTopicOrVariantIsAnErrorThatNamesIt) {
  (void)run(load(pendulum()), out());
  std::vector<Topic> topics = toy::topics();
  std::erase_if(topics, [](const Topic& topic) { return topic.name == "toy-pendulum"; });
  EXPECT_THAT(error_of([&] { (void)measure_again(OpenedRun(out()), topics); }),
              AllOf(HasSubstr("run.h5: experiment"), HasSubstr("unknown topic 'toy-pendulum'")));
}

TEST_F(Measured, IsWrittenWholeOrNotAtAll) {
  (void)run(load(pendulum()), out());
  const OpenedRun opened(out());
  const MeasuredRun measured = measure_again(opened, toy::topics());
  const auto write = [&](const fs::path& to) {
    return error_of([&] { (void)write_measured_run(measured, opened, to); });
  };
  EXPECT_THAT(write(out()), AllOf(HasSubstr(out().string()), HasSubstr("never overwritten")));
  const fs::path file = folder() / "file";
  std::ofstream(file) << "no folder";
  EXPECT_THAT(write(file / "below"), HasSubstr(file.string()));
  request_stop();
  const fs::path stopped = folder() / "a/b/stopped";
  EXPECT_THROW((void)write_measured_run(measured, opened, stopped), Stopped);
  EXPECT_FALSE(fs::exists(folder() / "a")) << "with the folders above it";
  EXPECT_THROW((void)measure_again(opened, toy::topics()), Stopped);
  clear_stop();
  fs::create_directory(folder() / "empty");
  EXPECT_EQ(write_measured_run(measured, opened, folder() / "empty"), folder() / "empty");
}

TEST_F(Measured, StoppedByCtrlCWhileASceneIsLoadedLeavesNothing) {
  (void)run(load(pendulum("load_delay_ms = 8000")), out());
  const fs::path log = folder() / "log";
  ToyProgram program({"measure", out().string(), "--out", (folder() / "measured").string()}, log);
  ASSERT_TRUE(await([&] { return text_of(log).find("loading") != std::string::npos; }));
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(), 2) << text_of(log);
  EXPECT_THAT(text_of(log), HasSubstr("nothing was written"));
  EXPECT_FALSE(fs::exists(folder() / "measured"));
}

class MeasureProgram : public ::testing::Test {
 protected:
  toy::Home home_;
};

TEST_F(MeasureProgram, SaysWhatChanged) {
  home_.write("experiments/toy-circle/disc.toml", toy::disc_experiment());
  ASSERT_EQ(home_.run("run toy-circle/disc --no-pictures").code, 0);
  const toy::Outcome outcome = home_.run("measure toy-circle/disc --no-pictures --json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("as they were, byte by byte"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("\"measured_from\""), HasSubstr("\"added\": []")));
  EXPECT_EQ(home_.run("check").code, 1) << "there is no reference";
  EXPECT_EQ(std::distance(fs::directory_iterator(home_.root() / "results/runs/toy-circle/disc"),
                          fs::directory_iterator()),
            2);
}

TEST_F(MeasureProgram, NeedsAFinishedRun) {
  home_.write("experiments/toy-circle/disc.toml", toy::disc_experiment());
  const toy::Outcome none = home_.run("measure toy-circle/disc");
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, AllOf(HasSubstr("has no finished run"), HasSubstr("geoprior run")));
  const toy::Outcome unknown = home_.run("measure toy-circle/disk");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'toy-circle/disc'"));
  home_.write("unfinished/journal.jsonl", "");
  const toy::Outcome unfinished = home_.run("measure " + (home_.root() / "unfinished").string());
  EXPECT_EQ(unfinished.code, 2);
  EXPECT_THAT(unfinished.err, HasSubstr("has no run.h5"));
  EXPECT_EQ(home_.run("measure").code, 2);
}

}  // namespace
}  // namespace geoprior::test
