#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"

namespace geoprior {

/// Options of the method "external": where its frames are, or which program makes them.
/// docs/external-methods.md
struct ExternalOptions {
  /// A folder of the layout (frame_layout.h), or numbered files "out/frame_%04d.ply" of one part;
  /// beside the experiment file, or with a command in its working folder. "{case}" and "{variant}"
  /// stand for names of the run.
  std::string frames;
  /// A program and its arguments. Those that are files beside the experiment file are given as
  /// absolute paths. Empty: nothing is started.
  std::vector<std::string> command;
  std::optional<std::string> part;  ///< that numbered files are
  std::vector<double> parameters;   ///< of numbered files, where no frames.csv has them
  /// A .csv whose column "vertex" has for each vertex of the scene the one of the frames.
  std::optional<std::string> correspondence;
  double time_limit_s = 3600;
  double output_limit_MB = 4096;
};
void describe(OptionVisitor& v, ExternalOptions& options);

}  // namespace geoprior
