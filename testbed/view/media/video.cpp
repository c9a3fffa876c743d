#include "testbed/view/media/video.h"

// Every frame of a run as a picture, and a video of them.

#include <array>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/scene_camera.h"
#include "testbed/view/child_process.h"
#include "testbed/view/display.h"
#include "testbed/view/figure/frame_times.h"
#include "testbed/view/figure/layout.h"
#include "testbed/view/media/sound_track.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

constexpr int kSampledFrames = 8;
constexpr const char* kFramePattern = "frame_%04d.png";

fs::path frame_file(const fs::path& folder, std::size_t index) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), kFramePattern, static_cast<int>(index));
  return folder / name.data();
}

/// One state, of one case, variants side by side: pictures of one size.
FigureView frame_view(const FigureView& view, const std::vector<double>& parameters,
                      const RunRecord& record) {
  FigureView frame = contact_sheet_view(record, view);
  frame.labels = view.labels;
  frame.above = view.above;
  frame.below = view.below;
  frame.parameters = parameters;
  frame.across = FigureView::Across::variants;
  return frame;
}

/// For a pattern of ffmpeg, in which % begins the number.
std::string escaped(const std::string& path) {
  std::string text;
  for (const char c : path) text += c == '%' ? std::string("%%") : std::string(1, c);
  return text;
}

/// What ffmpeg is to play besides the pictures.
struct HeardSound {
  std::string variant;
  double start_s = 0;
  fs::path file;
};

/// Pads to even sizes, which the usual pixel format needs. The pictures are counted by their time:
/// a limit on the frames that are written (-frames:v) would end the sound before it begins.
void encode(const std::string& ffmpeg, const fs::path& pictures,
            const std::optional<HeardSound>& sound, const Video& video, const fs::path& file) {
  PendingFile pending(file);
  const std::string duration = number_text((video.frames - 0.5) / video.frames_per_second);
  std::vector<std::string> command{ffmpeg, "-y", "-nostdin", "-loglevel", "error"};
  const auto add = [&](const std::vector<std::string>& more) {
    command.insert(command.end(), more.begin(), more.end());
  };
  add({"-framerate", number_text(video.frames_per_second), "-t", duration, "-i",
       escaped(pictures.string()) + "/" + kFramePattern});
  if (sound) {
    add({"-ss", number_text(sound->start_s), "-i", "file:" + sound->file.string(), "-map", "0:v",
         "-map", "1:a", "-c:a", "aac", "-b:a", "192k"});
  }
  add({"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p", "-f", "mp4",
       pending.temporary().string()});
  const ChildResult result = run_child(command);
  if (result.exit_code != 0) {
    throw Error("ffmpeg failed: " + result.reason(), file.string(),
                sound ? "an ffmpeg that can write mp4 with AAC; the frames are there"
                      : "an ffmpeg that can write mp4; the frames are there");
  }
  pending.commit();
}

/// The sound that is heard, and the rate of the frames: real time with a sound, else as wished.
std::optional<HeardSound> choose_sound(const OpenedRun& run, const FigureView& view,
                                       const std::vector<double>& parameters,
                                       const VideoOptions& options, Video& video) {
  constexpr double kLargestDrift = 1e-3;
  constexpr double kUsualRate = 25;
  const auto track = sound_track(run.record(), view, parameters, video.no_sound);
  const double real_time = track ? track->frames_per_second : kUsualRate;
  video.frames_per_second = options.frames_per_second.value_or(real_time);
  if (!track) return std::nullopt;
  if (std::abs(video.frames_per_second / real_time - 1) > kLargestDrift) {
    video.no_sound = "real time is " + rounded_text(real_time) + " frames a second, not " +
                     number_text(video.frames_per_second);
    return std::nullopt;
  }
  return HeardSound{track->variant, track->start_s, run.file(track->file)};
}

void draw_video(const OpenedRun& run, const FigureView& view, const VideoOptions& options,
                Video& video) {
  const RunRecord& record = run.record();
  const std::vector<double> parameters = frame_parameters(record, view);
  const auto sound = choose_sound(run, view, parameters, options, video);
  const auto samples =
      make_blocks(run, frame_view(view, evenly_chosen(parameters, kSampledFrames), record));
  const MadeFolders made(options.out);
  const Display display;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    throw_if_stopped();
    auto blocks = make_blocks(run, frame_view(view, {parameters[i]}, record));
    for (std::size_t b = 0; b < blocks.size(); ++b) take_look(blocks[b], samples[b]);
    write_png(draw_figure(blocks), frame_file(options.out, i));
    ++video.frames;
  }
  if (const auto ffmpeg = find_program("ffmpeg")) {
    encode(*ffmpeg, options.out, sound, video, options.out / "video.mp4");
    video.file = options.out / "video.mp4";
    if (sound) video.sound_of = sound->variant;
  }
}

}  // namespace

Video make_video(const OpenedRun& run, const FigureView& view, const VideoOptions& options) {
  Video video;
  const std::string file = (run.folder() / "run.h5").string();
  try {
    draw_video(run, with_scene_camera(view, run.record(), file), options, video);
  } catch (const Stopped&) {
    video.stopped = true;
  }
  return video;
}

}  // namespace geoprior
