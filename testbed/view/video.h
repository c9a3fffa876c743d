#pragma once

#include <filesystem>
#include <optional>

#include "testbed/figure_view.h"
#include "testbed/runner/opened_run.h"

namespace geoprior {

struct VideoOptions {
  double frames_per_second = 25;
  std::filesystem::path out;  ///< folder of frame_0000.png … and video.mp4
};

struct Video {
  int frames = 0;
  std::optional<std::filesystem::path> file;  ///< absent: ffmpeg is not installed, or stopped
  bool stopped = false;                       ///< Ctrl-C
};

/// Draws every frame as render_run draws its states, variants side by side, all under one camera
/// and one colour range (those of eight frames, evenly spaced), and lets ffmpeg make a video of
/// them. A file is there whole or not at all.
/// @throws Error  when there is nothing to draw, or with the message of ffmpeg
Video make_video(const OpenedRun& run, const FigureView& view, const VideoOptions& options);

}  // namespace geoprior
