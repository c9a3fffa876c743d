#include "testbed/view/video.h"

// Every frame of a run as a picture, and a video of them.

#include <array>
#include <cstdio>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/runner/scene_camera.h"
#include "testbed/runner/stop.h"
#include "testbed/view/child_process.h"
#include "testbed/view/display.h"
#include "testbed/view/figure_layout.h"
#include "testbed/view/frame_times.h"

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

/// Pads to even sizes, which the usual pixel format needs.
void encode(const std::string& ffmpeg, const VideoOptions& options, int frames,
            const fs::path& file) {
  PendingFile pending(file);
  const ChildResult result =
      run_child({ffmpeg, "-y", "-nostdin", "-loglevel", "error", "-framerate",
                 std::to_string(options.frames_per_second), "-i",
                 escaped(options.out.string()) + "/" + kFramePattern, "-frames:v",
                 std::to_string(frames), "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white",
                 "-pix_fmt", "yuv420p", "-f", "mp4", pending.temporary().string()});
  if (result.exit_code != 0) {
    throw Error("ffmpeg failed: " + result.errors, file.string(),
                "an ffmpeg that can write mp4; the frames are there");
  }
  pending.commit();
}

void draw_video(const OpenedRun& run, const FigureView& view, const VideoOptions& options,
                Video& video) {
  const RunRecord& record = run.record();
  const std::vector<double> parameters = frame_parameters(record, view);
  const auto samples =
      make_blocks(run, frame_view(view, evenly_chosen(parameters, kSampledFrames), record));
  const MadeFolders made(options.out);
  const Display display;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    throw_if_stopped();
    auto blocks = make_blocks(run, frame_view(view, {parameters[i]}, record));
    for (std::size_t b = 0; b < blocks.size(); ++b) blocks[b].look = samples[b].look;
    write_png(draw_figure(blocks), frame_file(options.out, i));
    ++video.frames;
  }
  if (const auto ffmpeg = find_program("ffmpeg")) {
    encode(*ffmpeg, options, video.frames, options.out / "video.mp4");
    video.file = options.out / "video.mp4";
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
