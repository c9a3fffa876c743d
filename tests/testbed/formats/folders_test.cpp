// What a run, a resumption and an export leave alone: everything that is not theirs, and what lies
// behind a symbolic link.

#include "testbed/formats/folders.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>

#include <fstream>

#include "core/error.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/runner/journal/journal.h"
#include "testbed/runner/journal/run_file.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/run_folder.h"
#include "testbed/view/export.h"
#include "tests/testbed/await.h"
#include "tests/testbed/fake_run.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

/// A run of pendulums that a stop ended in its second variant, and files that are somebody's.
class OwnFiles : public RunTest {
 protected:
  void SetUp() override {
    RunTest::SetUp();
    fs::create_directories(victim());
    for (const char* name : {"bob_0000.vtp", "bob_0001.vtp", "thesis.tex", "a.state"}) {
      std::ofstream(victim() / name) << "years of work";
    }
  }

  [[nodiscard]] fs::path out() const { return folder() / "out"; }
  [[nodiscard]] fs::path victim() const { return folder() / "victim"; }
  [[nodiscard]] fs::path journal() const { return out() / "journal.jsonl"; }

  void expect_victim_is_whole() const {
    EXPECT_EQ(std::distance(fs::directory_iterator(victim()), {}), 4);
    for (const auto& entry : fs::directory_iterator(victim())) {
      EXPECT_EQ(text_of(entry.path()), "years of work") << entry.path();
    }
  }

  /// Kills the run once it has logged `frames` frames. Each variant has 7.
  fs::path kill_after(std::size_t frames, const std::string& options = {}) const {
    const fs::path file = pendulum("frames = 6\nframe_delay_ms = 30", options);
    ToyProgram program({"run", file.string(), "--no-pictures", "--out", out().string()},
                       folder() / "log");
    EXPECT_TRUE(await([&] {
      const std::string text = text_of(journal());
      std::size_t seen = 0;
      for (std::size_t at = 0; (at = text.find("\"frame\"", at)) != std::string::npos; ++at) ++seen;
      return seen >= frames;
    }));
    program.signal(SIGKILL);
    EXPECT_EQ(program.wait(), -SIGKILL);
    return file;
  }

  /// One line that names `place`, exit code 2, through the program.
  void expect_resume_refused(const fs::path& file, const std::string& place) const {
    ToyProgram program({"run", file.string(), "--no-pictures", "--out", out().string(), "--resume"},
                       folder() / "log");
    EXPECT_EQ(program.wait(), 2) << place;
    const std::string text = text_of(folder() / "log");
    EXPECT_THAT(text.substr(std::min(text.find("error: "), text.size())), HasSubstr(place));
  }
};

TEST_F(OwnFiles, BehindALinkAreNeitherReplacedNorRemoved) {
  // The second variant is resumed: its folders, and those above.
  const fs::path file = kill_after(10);
  for (const char* link :
       {"frames/default/euler", "frames/default", "frames", "checkpoints/default/euler",
        "checkpoints/default", "checkpoints", "artifacts/default/euler", "artifacts"}) {
    const fs::path place = out() / link;
    const fs::path aside = folder() / "aside";
    const bool there = fs::exists(place);
    if (there) fs::rename(place, aside);
    fs::create_directories(place.parent_path());
    fs::create_directory_symlink(victim(), place);
    const auto before = lasting_files(out());
    expect_resume_refused(file, (fs::canonical(out()) / link).string() + ": is a symbolic link");
    EXPECT_EQ(lasting_files(out()), before) << link;
    EXPECT_FALSE(fs::exists(out() / "run.h5"));
    expect_victim_is_whole();
    fs::remove(place);
    if (there) fs::rename(aside, place);
  }
  const ExecuteResult resumed = run(load(file), out(), true);
  const ExecuteResult undisturbed = run(load(file), folder() / "undisturbed");
  EXPECT_EQ(resumed.record.content_sha256, undisturbed.record.content_sha256);
}

TEST_F(OwnFiles, BehindALinkInThePlaceOfAFileAreLeftAlone) {
  const fs::path file = kill_after(10);
  const fs::path frame = out() / "frames/default/euler/bob_0005.vtp";
  fs::create_symlink(victim() / "thesis.tex", frame);
  expect_resume_refused(file, "euler/bob_0005.vtp: is a symbolic link");
  expect_victim_is_whole();
  fs::remove(frame);
  // Temporary names are nobody's: the links themselves give way.
  for (const char* name :
       {"frames/default/midpoint/bob_0004.vtp.geoprior-tmp", "run.h5.geoprior-tmp"}) {
    fs::create_directories((out() / name).parent_path());
    fs::create_symlink(victim() / "thesis.tex", out() / name);
  }
  const ExecuteResult resumed = run(load(file), out(), true);
  expect_victim_is_whole();
  const ExecuteResult undisturbed = run(load(file), folder() / "undisturbed");
  EXPECT_EQ(resumed.record.content_sha256, undisturbed.record.content_sha256);
}

TEST_F(OwnFiles, InTheFoldersOfARunOutliveItsResumption) {
  const fs::path file = kill_after(10, "checkpoints = false");
  std::vector<fs::path> own;
  for (const char* name : {"frames/default/euler/mine.vtp", "frames/default/euler/bob_9999.vtp",
                           "artifacts/default/euler/mine.wav", "checkpoints/default/euler/mine",
                           "checkpoints/mine", "probe", "frames/mine"}) {
    own.push_back(out() / name);
    fs::create_directories(own.back().parent_path());
    std::ofstream(own.back()) << "mine";
  }
  run(load(file), out(), true);
  EXPECT_TRUE(fs::exists(out() / "run.h5"));
  for (const fs::path& mine : own) EXPECT_EQ(text_of(mine), "mine") << mine;
}

TEST_F(OwnFiles, ThatAFinishedVariantLeftAreWhatTheyWere) {
  // The first variant is finished, the second is resumed.
  const fs::path file = kill_after(10);
  const fs::path frame = out() / "frames/default/exact/bob_0003.vtp";
  const fs::path other = out() / "frames/default/exact/bob_0001.vtp";
  const std::string whole = text_of(frame);
  fs::copy_file(other, frame, fs::copy_options::overwrite_existing);
  expect_resume_refused(file, "bob_0003.vtp: is damaged or another file");
  EXPECT_FALSE(fs::exists(out() / "run.h5"));
  fs::remove(frame);
  expect_resume_refused(file, "bob_0003.vtp");
  write_file_atomically(frame, std::string_view(whole));
  EXPECT_FALSE(run(load(file), out(), true).stopped);
}

TEST_F(OwnFiles, OfAFinishedRunAreNoLinks) {
  make_fake_run(out());
  for (const char* name : {"run.h5", "journal.jsonl"}) {
    fs::rename(out() / name, folder() / name);
    fs::create_symlink(folder() / name, out() / name);
    EXPECT_THAT(error_of([&] { const OpenedRun run(out()); }), HasSubstr("run.h5: ")) << name;
    fs::remove(out() / name);
    fs::rename(folder() / name, out() / name);
  }
  EXPECT_NO_THROW(OpenedRun{out()});
}

TEST_F(OwnFiles, APipeIsNoLogOfARunAndNoneIsWaitedFor) {
  fs::create_directories(out());
  ASSERT_EQ(::mkfifo(journal().c_str(), 0600), 0);
  EXPECT_FALSE(recorded_hash(out()));
  EXPECT_FALSE(recorded_result(out()));
  expect_resume_refused(pendulum("frames = 6"), "journal.jsonl");
}

TEST_F(OwnFiles, APipeIsNotReplacedByAFile) {
  const fs::path pipe = folder() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(error_of([&] { write_file_atomically(pipe, std::string_view("text")); }),
              HasSubstr(pipe.string() + ": is a pipe"));
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(OwnFiles, ALinkToNothingInThePlaceOfTheFolderStays) {
  const fs::path link = folder() / "dangling";
  fs::create_directory_symlink(folder() / "nowhere", link);
  EXPECT_THROW(MadeFolders{link}, Error);
  EXPECT_THROW(MadeFolders{link / "deeper"}, Error);
  EXPECT_TRUE(fs::is_symlink(link));
}

TEST_F(OwnFiles, ALinkIsNoLogOfARun) {
  const fs::path file = kill_after(10);
  fs::rename(journal(), folder() / "elsewhere");
  fs::create_symlink(folder() / "elsewhere", journal());
  const std::string before = text_of(folder() / "elsewhere");
  expect_resume_refused(file, journal().string() + ": is a symbolic link");
  EXPECT_EQ(text_of(folder() / "elsewhere"), before);
}

TEST_F(OwnFiles, AJournalNamesNoFileOutsideOfItsPlace) {
  const fs::path file = kill_after(10);
  std::string journal_text = text_of(journal());
  journal_text.erase(journal_text.rfind('\n') + 1);
  const journal::Place place{"default", "euler"};
  const std::vector<journal::Line> foreign{
      journal::ArtifactLine{place, {"../victim/thesis.tex", ""}},
      journal::ArtifactLine{place, {victim() / "thesis.tex", ""}},
      journal::ArtifactLine{place, {"artifacts/default/euler/../../../../victim/thesis.tex", ""}},
      journal::ArtifactLine{place, {"artifacts/default/exact/swing.wav", ""}},
      journal::ArtifactLine{place, {"spec.toml", ""}},
      journal::CheckpointLine{place, {"../victim/a.state", ""}, 0, 0, 0, {}},
      journal::CheckpointLine{place, {"frames/default/euler/bob_0000.vtp", ""}, 0, 0, 0, {}},
  };
  const auto lines = std::count(journal_text.begin(), journal_text.end(), '\n');
  for (const journal::Line& line : foreign) {
    std::ofstream(journal()) << journal_text << journal::to_text(line) << '\n';
    const auto before = lasting_files(out());
    expect_resume_refused(file, "journal.jsonl:" + std::to_string(lines + 1) + ": name: '");
    EXPECT_EQ(lasting_files(out()), before);
    expect_victim_is_whole();
  }
}

TEST_F(OwnFiles, BesideAnEmptyJournalAreNotTheRuns) {
  const fs::path file = circle();
  for (const char* name : {"frames/default/exact/mine.vtp", "artifacts/mine", "spec.toml",
                           "spec.json", "checkpoints/a.state", "notes.txt"}) {
    fs::create_directories((out() / name).parent_path());
    std::ofstream(out() / name) << "mine";
    std::ofstream(journal()) << "";
    expect_resume_refused(file, "the journal is empty, and '" + fs::path(name).begin()->string());
    EXPECT_EQ(text_of(out() / name), "mine");
    EXPECT_TRUE(fs::exists(journal()));
    fs::remove_all(out());
  }
}

TEST_F(OwnFiles, AnEmptyJournalBesideTheRunsOwnBeginningGoesOn) {
  const Experiment experiment = load(circle());
  fs::create_directories(out());
  std::ofstream(out() / "spec.toml") << experiment.resolved_toml;
  std::ofstream(out() / "spec.json.geoprior-tmp") << "half";
  std::ofstream(journal()) << R"({"kind":"ru)";
  EXPECT_FALSE(run(experiment, out(), true).stopped);
  EXPECT_TRUE(fs::exists(out() / "run.h5"));
}

TEST_F(OwnFiles, CalledProbeAreKeptAndBlockNobody) {
  fs::create_directories(out());
  std::ofstream(out() / "probe") << "mine";
  run(load(circle()), out());
  EXPECT_EQ(text_of(out() / "probe"), "mine");
  fs::create_directories(folder() / "other/probe");
  const fs::path file = pendulum();
  EXPECT_FALSE(run(load(file), folder() / "other").stopped);
  EXPECT_TRUE(fs::is_directory(folder() / "other/probe"));
  EXPECT_TRUE(run(load(file), folder() / "other", true).was_finished);
}

TEST_F(OwnFiles, OfAVariantCalledCheckpointsAreKept) {
  const fs::path file = write_experiment(
      "toy-pendulum/named",
      "title = \"t\"\ntopic = \"toy-pendulum\"\n[scene]\nframes = 2\n"
      "[[variant]]\nname = \"checkpoints\"\nmethod = \"explicit-euler\"\n"
      "[[sweep]]\nkey = \"seed\"\nvalues = [1, 2]\nnames = [\"checkpoints\", \"frames\"]\n");
  const ExecuteResult result = run(load(file), out());
  EXPECT_FALSE(fs::exists(out() / "checkpoints"));
  for (const CaseRecord& one : result.record.cases) {
    ASSERT_EQ(one.variants.at(0).frames.size(), 3U);
    for (const FrameRecord& frame : one.variants[0].frames) {
      for (const StoredFile& stored : frame.files) EXPECT_TRUE(fs::exists(out() / stored.name));
    }
  }
}

TEST_F(OwnFiles, WhatIsRefusedLeavesNoFolder) {
  const fs::path bad_scene = pendulum("damping = 100");
  const fs::path deep = folder() / "new/deep/out";
  EXPECT_THAT(error_of([&] { run(load(bad_scene), deep); }), HasSubstr("over-damped"));
  EXPECT_FALSE(fs::exists(folder() / "new"));
  EXPECT_THAT(error_of([&] { execute(load(bad_scene), toy::topics(), {}); }),
              HasSubstr("over-damped"));
  EXPECT_FALSE(fs::exists(folder() / "runs"));
  fs::create_directories(out());
  EXPECT_THAT(error_of([&] { run(load(bad_scene), out()); }), HasSubstr("over-damped"));
  EXPECT_TRUE(fs::is_empty(out()));
  EXPECT_THAT(error_of([&] { run(load(circle()), out(), true); }), HasSubstr("journal.jsonl"));
  EXPECT_TRUE(fs::is_empty(out()));
}

TEST_F(OwnFiles, OfAForeignCopyAreNotTakenForThoseOfTheExperiment) {
  const Experiment ours = load(circle());
  fs::create_directories(folder() / "copy/experiments/toy-circle");
  const fs::path copy = folder() / "copy/experiments/toy-circle/disc.toml";
  fs::copy_file(ours.file, copy);
  const Experiment foreign = load(copy);
  ASSERT_EQ(foreign.hash, ours.hash);
  execute(foreign, toy::topics(), {});
  EXPECT_TRUE(find_run(foreign).has_value());
  EXPECT_FALSE(find_run(ours).has_value());
}

TEST_F(OwnFiles, OfAStoppedForeignCopyAreNotGoneOnWith) {
  const Experiment ours = load(pendulum());
  const fs::path copy = folder() / "copy/experiments/toy-pendulum/swing.toml";
  fs::create_directories(copy.parent_path());
  fs::copy_file(ours.file, copy);
  const Experiment foreign = load(copy);
  request_stop();
  EXPECT_TRUE(execute(foreign, toy::topics(), {}).stopped);
  clear_stop();
  EXPECT_TRUE(find_unfinished_run(foreign).has_value());
  EXPECT_FALSE(find_unfinished_run(ours).has_value());
  ExecuteRequest resume;
  resume.resume = true;
  EXPECT_THAT(error_of([&] { execute(ours, toy::topics(), resume); }),
              HasSubstr("there is no run"));
}

TEST_F(OwnFiles, AnExportFollowsNoLink) {
  make_fake_run(out());
  const fs::path to = folder() / "to";
  export_run(OpenedRun(out()), "obj", to);
  fs::remove_all(to / "default");
  fs::create_directory_symlink(victim(), to / "default");
  EXPECT_THAT(error_of([&] { export_run(OpenedRun(out()), "obj", to); }),
              HasSubstr((to / "default").string() + ": is a symbolic link"));
  expect_victim_is_whole();
  fs::remove_all(out() / "frames/default/first-box");
  fs::create_directory_symlink(victim(), out() / "frames/default/first-box");
  EXPECT_THAT(error_of([&] { export_run(OpenedRun(out()), "obj", folder() / "new"); }),
              HasSubstr("first-box: is a symbolic link"));
  EXPECT_FALSE(fs::exists(folder() / "new"));
}

TEST_F(OwnFiles, TheDefaultFoldersOfExportAndVideoAreNoLinks) {
  make_fake_run(out());
  for (const char* name : {"export-obj", "video"}) {
    const fs::path away = folder() / "empty";
    fs::create_directories(away);
    fs::create_directory_symlink(away, out() / name);
    const std::vector<std::string> command =
        std::string(name) == "video"
            ? std::vector<std::string>{"video", out().string()}
            : std::vector<std::string>{"export", out().string(), "--format", "obj"};
    ToyProgram program(command, folder() / "log");
    EXPECT_EQ(program.wait(), 2);
    EXPECT_THAT(text_of(folder() / "log"), HasSubstr(std::string(name) + ": is a symbolic link"));
    EXPECT_TRUE(fs::is_empty(away));
  }
}

TEST_F(OwnFiles, AnExportOfNothingLeavesNoFolder) {
  RunRecord record = make_fake_run(out());
  for (VariantRecord& variant : record.cases[0].variants) variant.frames.clear();
  write_fake_run(record, out());
  EXPECT_THAT(error_of([&] { export_run(OpenedRun(out()), "obj", folder() / "to/deep"); }),
              HasSubstr("no part"));
  EXPECT_FALSE(fs::exists(folder() / "to"));
}

TEST_F(OwnFiles, AreNotWrittenThroughATemporaryName) {
  const fs::path file = folder() / "file";
  fs::create_symlink(victim() / "thesis.tex", folder() / "file.geoprior-tmp");
  write_file_atomically(file, std::string_view("new"));
  EXPECT_EQ(text_of(file), "new");
  EXPECT_FALSE(fs::is_symlink(file));
  expect_victim_is_whole();
}

TEST_F(OwnFiles, LieBelowAPathWithoutLinks) {
  EXPECT_EQ(path_below(folder(), "a/b"), folder() / "a/b");
  for (const char* path : {"..", "a/..", "a/../../b", "/etc/passwd"}) {
    EXPECT_THAT(error_of([&] { (void)path_below(folder(), path); }),
                AllOf(HasSubstr("leaves its folder"), HasSubstr(folder().string())));
  }
  fs::create_directory_symlink(victim(), folder() / "link");
  EXPECT_THAT(error_of([&] { (void)path_below(folder(), "link/thesis.tex"); }),
              HasSubstr((folder() / "link").string() + ": is a symbolic link"));
  // The folder itself may be one: it is what somebody asked for.
  EXPECT_EQ(path_below(folder() / "link", "thesis.tex"), folder() / "link/thesis.tex");
}

TEST_F(OwnFiles, MadeFoldersGoWhenTheyStayEmpty) {
  {
    const MadeFolders made(folder() / "a/b/c");
    EXPECT_TRUE(fs::is_directory(folder() / "a/b/c"));
  }
  EXPECT_FALSE(fs::exists(folder() / "a"));
  {
    MadeFolders made(folder() / "a/b/c");
    const MadeFolders moved(std::move(made));
    std::ofstream(folder() / "a/b/file") << "x";
  }
  EXPECT_TRUE(fs::exists(folder() / "a/b/file"));
  EXPECT_FALSE(fs::exists(folder() / "a/b/c"));
}

}  // namespace
}  // namespace geoprior::test
