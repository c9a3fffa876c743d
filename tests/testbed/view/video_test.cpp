// Videos of a run, their sound and its spectrogram.

#include "testbed/view/media/video.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "testbed/formats/wav_file.h"
#include "testbed/runner/process/stop.h"
#include "testbed/view/media/sound_track.h"
#include "testbed/view/media/spectrogram.h"
#include "tests/testbed/fake_run.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/view/views.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Puts a folder first on the PATH, for as long as it lives.
class PathOf {
 public:
  explicit PathOf(const fs::path& folder) : old_(std::getenv("PATH")) {
    ::setenv("PATH", (folder.string() + ":" + old_).c_str(), 1);
  }
  ~PathOf() { ::setenv("PATH", old_.c_str(), 1); }
  PathOf(const PathOf&) = delete;
  PathOf& operator=(const PathOf&) = delete;

 private:
  std::string old_;
};

/// A program named ffmpeg that runs `script`; its last argument is $file.
void make_ffmpeg(const fs::path& folder, const std::string& script) {
  write_file_atomically(folder / "ffmpeg",
                        std::string_view("#!/bin/sh\nfor file; do :; done\n" + script + "\n"));
  fs::permissions(folder / "ffmpeg", fs::perms::owner_all);
}

/// The fake run with its frames at these times (s) and a sound of the second box.
RunRecord make_sounding_run(const fs::path& folder, const std::vector<double>& times) {
  RunRecord record = make_fake_run(folder, kFlat);
  CaseRecord& of = record.cases[0];
  of.parameter_name = "time";
  of.parameter_unit = "s";
  for (VariantRecord& variant : of.variants) {
    for (std::size_t i = 0; i < times.size(); ++i) variant.frames[i].parameter = times[i];
  }
  const auto wav = wav_bytes({8000, Eigen::MatrixXd::Constant(8000, 1, 0.25)});
  const std::string name = "artifacts/default/second-box/mix.wav";
  make_folders((folder / name).parent_path());
  write_file_atomically(folder / name, std::span<const std::byte>(wav));
  of.variants[1].artifacts = {{"artifacts/default/second-box/notes.txt", ""}, {name, sha256(wav)}};
  write_fake_run(record, folder);
  return record;
}

/// What the ffmpeg of this script is called with; the video holds it.
Video video_of(const fs::path& folder, std::optional<double> frames_per_second) {
  FigureView view = side_view();
  view.variants = {"second-box"};
  return make_video(OpenedRun(folder / "run"), view, {frames_per_second, folder / "video"});
}

TEST(Video, HasAPictureAFrameAndIsWholeOrAbsent) {
  const TestFolder folder;
  make_fake_run(folder.path / "run", kFlat);
  const PathOf path(folder.path);
  FigureView view = side_view();
  view.variants = {"first-box"};
  make_ffmpeg(folder.path, "echo half > \"$file\"; echo no encoder >&2; exit 1");
  const fs::path out = folder.path / "50% video";
  EXPECT_THAT(test::error_of([&] {
                make_video(OpenedRun(folder.path / "run"), view, {25, out});
              }),
              HasSubstr("no encoder"));
  EXPECT_TRUE(fs::exists(out / "frame_0002.png"));
  EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 3) << "three frames, no half video";
  make_ffmpeg(folder.path, "echo \"$@\" > \"$file\"");
  const Video video = make_video(OpenedRun(folder.path / "run"), view, {25, out});
  EXPECT_EQ(video.frames, 3);
  ASSERT_EQ(video.file, out / "video.mp4");
  EXPECT_THAT(read_whole_file(out / "video.mp4"), HasSubstr("50%% video/frame_%04d.png"));
}

TEST(SoundTrack, IsTheFirstWavFileOfADrawnVariantAndRealTimeIsItsRate) {
  const TestFolder folder;
  const RunRecord record = make_sounding_run(folder.path, {0.5, 0.54, 0.58});
  std::string problem;
  const auto track = sound_track(record, {}, {0.5, 0.54, 0.58}, problem);
  ASSERT_TRUE(track);
  EXPECT_EQ(track->variant, "second-box");
  EXPECT_EQ(track->file.name, "artifacts/default/second-box/mix.wav");
  EXPECT_NEAR(track->frames_per_second, 25, 1e-9);
  EXPECT_EQ(track->start_s, 0.5);
  EXPECT_EQ(problem, "");
  FigureView first_only;
  first_only.variants = {"first-box"};
  EXPECT_FALSE(sound_track(record, first_only, {0.5, 0.54, 0.58}, problem));
  EXPECT_EQ(problem, "") << "what is not drawn is not missed";
}

TEST(SoundTrack, IsAbsentWhereFramesCannotKeepStepWithIt) {
  const TestFolder folder;
  RunRecord record = make_sounding_run(folder.path, {0, 0.04, 0.08});
  std::string problem;
  EXPECT_FALSE(sound_track(record, {}, {0, 0.01, 0.08}, problem));
  EXPECT_THAT(problem, HasSubstr("evenly"));
  EXPECT_FALSE(sound_track(record, {}, {0.04}, problem));
  EXPECT_THAT(problem, HasSubstr("one frame"));
  EXPECT_FALSE(sound_track(record, {}, {-1, 0, 1}, problem));
  EXPECT_THAT(problem, HasSubstr("before the sound"));
  record.cases[0].parameter_unit = "deg";
  record.cases[0].parameter_name = "angle";
  EXPECT_FALSE(sound_track(record, {}, {0, 45, 90}, problem));
  EXPECT_THAT(problem, HasSubstr("angle"));
}

TEST(Video, HasTheSoundOfAVariantWithItsFramesInRealTime) {
  const TestFolder folder;
  make_sounding_run(folder.path / "run", {0.5, 0.75, 1});
  const PathOf path(folder.path);
  make_ffmpeg(folder.path, "echo \"$@\" > \"$file\"");
  const Video video = video_of(folder.path, {});
  EXPECT_EQ(video.sound_of, "second-box");
  EXPECT_EQ(video.frames_per_second, 4);
  const std::string command = read_whole_file(folder.path / "video/video.mp4");
  const std::string wav = (folder.path / "run/artifacts/default/second-box/mix.wav").string();
  EXPECT_THAT(command, HasSubstr("-framerate 4 -t 0.625 -i ")) << "2.5 frames: the third begins";
  EXPECT_THAT(command, HasSubstr("-ss 0.5 -i file:" + wav + " -map 0:v -map 1:a -c:a aac"));
  const Video slow = video_of(folder.path, 2);
  EXPECT_FALSE(slow.sound_of);
  EXPECT_THAT(slow.no_sound, HasSubstr("real time is 4 frames a second"));
  const std::string silent = read_whole_file(folder.path / "video/video.mp4");
  EXPECT_THAT(silent, testing::Not(HasSubstr("aac")));
  EXPECT_THAT(silent, HasSubstr("-framerate 2 "));
}

TEST(Video, OfAnFfmpegWithoutTheCodecIsOneErrorThatSaysSo) {
  const TestFolder folder;
  make_sounding_run(folder.path / "run", {0, 0.25, 0.5});
  const PathOf path(folder.path);
  make_ffmpeg(folder.path, "echo \"Unknown encoder 'aac'\" >&2; exit 1");
  EXPECT_THAT(test::error_of([&] { video_of(folder.path, {}); }),
              testing::AllOf(HasSubstr("Unknown encoder 'aac'"), HasSubstr("mp4 with AAC")));
  EXPECT_FALSE(fs::exists(folder.path / "video/video.mp4"));
  std::ofstream(folder.path / "run/artifacts/default/second-box/mix.wav", std::ios::app) << "more";
  EXPECT_THAT(test::error_of([&] { video_of(folder.path, {}); }), HasSubstr("mix.wav"));
}

TEST(Spectrogram, IsDrawnWithFramesWhereTheRunHasASound) {
  const TestFolder folder;
  make_fake_run(folder.path / "mute");
  EXPECT_TRUE(draw_spectrograms(OpenedRun(folder.path / "mute"), {}).empty());
  EXPECT_FALSE(fs::exists(folder.path / "mute/spectrogram.png"));
  const fs::path run = folder.path / "run";
  make_sounding_run(run, {0, 0.5, 1});
  ::unsetenv("DISPLAY");
  EXPECT_THAT(draw_spectrograms(OpenedRun(run), side_view()),
              testing::ElementsAre(run / "spectrogram.png"));
  EXPECT_EQ(read_whole_file(run / "spectrogram.png").substr(1, 3), "PNG");
  EXPECT_FALSE(fs::exists(run / "strip-of-frames.png"));
}

TEST(Spectrogram, IsDrawnOfEachCaseThatTheViewNames) {
  const TestFolder folder;
  RunRecord record = make_sounding_run(folder.path, {0, 0.5, 1});
  record.cases.push_back(record.cases[0]);
  record.cases[1].name = "mute";
  for (VariantRecord& variant : record.cases[1].variants) {
    variant.frames.clear();
    variant.artifacts.clear();
  }
  record.cases.push_back(record.cases[1]);
  record.cases[2].name = "again";
  StoredFile sound = record.cases[0].variants[1].artifacts.back();
  const fs::path heard = folder.path / "artifacts/again/second-box/mix.wav";
  make_folders(heard.parent_path());
  fs::copy_file(folder.path / sound.name, heard);
  sound.name = "artifacts/again/second-box/mix.wav";
  record.cases[2].variants[1].artifacts = {sound};
  write_fake_run(record, folder.path);
  FigureView view = side_view();
  view.cases = {"mute", "again", "default"};
  EXPECT_THAT(draw_spectrograms(OpenedRun(folder.path), view),
              testing::ElementsAre(folder.path / "spectrogram.png",
                                   folder.path / "spectrogram-default.png"));
  EXPECT_NE(read_whole_file(folder.path / "spectrogram.png"),
            read_whole_file(folder.path / "spectrogram-default.png"));
}

TEST(Video, IsLeftOutAfterCtrlC) {
  const TestFolder folder;
  make_fake_run(folder.path);
  request_stop();
  const Video video = make_video(OpenedRun(folder.path), {}, {25, folder.path / "video"});
  clear_stop();
  EXPECT_TRUE(video.stopped);
  EXPECT_EQ(video.frames, 0);
  EXPECT_FALSE(video.file);
}

}  // namespace
}  // namespace geoprior
