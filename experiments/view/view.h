#pragma once

#include <filesystem>
#include <optional>

#include "experiments/runner/run_record.h"
#include "experiments/runner/spec.h"

namespace geoprior {

/// Draws figure.png of a run: variants side by side, one camera, one colour range, labels, scalar
/// bar with unit; and contact-sheet.png where the view asks for one. Needs no display: starts a
/// virtual X server of its own when there is none. Throws Error naming what is missing.
void render_run(const std::filesystem::path& run_folder, const FigureView& view);

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
Video make_video(const std::filesystem::path& run_folder, const FigureView& view,
                 const VideoOptions& options);

/// Writes every frame of every variant below `out` as obj, ply or one animated glb a variant.
void export_run(const std::filesystem::path& run_folder, const std::string& format,
                const std::filesystem::path& out);

/// Root of the clone: where experiments/ and results/ are found, above the executable.
std::filesystem::path geoprior_home();

/// A file named in an experiment: absolute, relative to the folder of the experiment's file, or to
/// a folder of the clone ("data").
/// @param where  key that names it, for the message
/// @throws Error  naming the places looked at
std::filesystem::path find_file(const std::string& name, const std::filesystem::path& folder,
                                const std::filesystem::path& of_clone, const std::string& where);

/// Runs results/<script>.py with Debian's Python; throws Error with its message on failure, naming
/// what to install.
void run_python(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace geoprior
