#pragma once

#include <optional>
#include <string>

#include "core/options.h"
#include "testbed/topic.h"

namespace geoprior::sketch {

/// Flags of `geoprior sketch`.
struct SketchCommandOptions {
  std::optional<std::string> photo;
  std::optional<std::string> out;
  bool force = false;
};
void describe(OptionVisitor& v, SketchCommandOptions& options);

/// `geoprior sketch <drawing.svg>`: decides by what is drawn what it is a drawing of, writes the
/// experiment that makes its surface and pattern, runs it, and leaves a folder with the pattern, a
/// picture, the surface and that experiment (command/drawn_experiment.h, result_folder.h).
/// @param topic  makes the topic that runs it
TopicCommand sketch_command(Topic (*topic)());

}  // namespace geoprior::sketch
