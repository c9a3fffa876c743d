#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "testbed/figure_view.h"
#include "testbed/runner/opened_run.h"

namespace geoprior {

struct VideoOptions {
  /// Absent: real time where the run has a sound that fits, else 25.
  std::optional<double> frames_per_second;
  std::filesystem::path out;  ///< folder of frame_0000.png … and video.mp4
};

struct Video {
  int frames = 0;
  std::optional<std::filesystem::path> file;  ///< absent: ffmpeg is not installed, or stopped
  bool stopped = false;                       ///< Ctrl-C
  double frames_per_second = 25;
  std::optional<std::string> sound_of;  ///< variant whose sound is heard
  std::string no_sound;                 ///< why none is, though the run has one
};

/// Draws every frame as render_run draws its states, variants side by side, all under one camera
/// and one colour range (those of eight frames, evenly spaced), and lets ffmpeg make a video of
/// them. Where a drawn variant has a sound (sound_track.h) it is heard, with the frames in real
/// time; a rate of the caller's that is not real time leaves it out. A file is there whole or not
/// at all.
/// @throws Error  when there is nothing to draw, or with the message of ffmpeg
Video make_video(const OpenedRun& run, const FigureView& view, const VideoOptions& options);

}  // namespace geoprior
