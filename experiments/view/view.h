#pragma once

#include <filesystem>

#include "experiments/runner/run_record.h"
#include "experiments/runner/spec.h"

namespace geoprior {

/// Draws figure.png of a run: variants side by side, one camera, one colour range, labels, scalar
/// bar with unit. Needs no display: starts a virtual X server of its own when there is none. Throws
/// Error naming what is missing.
void render_run(const std::filesystem::path& run_folder, const FigureView& view);

/// Writes every frame of every variant below `out` as obj, ply or one animated glb a variant.
void export_run(const std::filesystem::path& run_folder, const std::string& format,
                const std::filesystem::path& out);

/// Root of the clone: where experiments/ and results/ are found, above the executable.
std::filesystem::path geoprior_home();

/// Runs results/<script>.py with Debian's Python; throws Error with its message on failure, naming
/// what to install.
void run_python(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace geoprior
