#pragma once

#include "testbed/runner/spec/toml_tree.h"
#include "testbed/topic.h"

namespace geoprior {

/// Where the frames of the cases that a figure may draw end: the latest of them. Absent when the
/// topic cannot tell from the options of the scene.
/// @param root  an experiment file without [quick]
std::optional<LastParameter> last_parameter_of(const TomlNode& root, const Topic& topic,
                                               bool quick);

/// Refuses a frame of [figure_view] (`at`, `parameters`) beyond the end of the run: the last frame
/// would be drawn in its place and nobody told. What is judged is the run that the file describes,
/// or the longer one that --set makes of it; a quick or otherwise shortened run shows its own end
/// instead, and `root` is changed to ask for that.
/// @param file  the experiment file as it is written
/// @param root  the same after [quick] and --set
/// @throws Error  naming file, line, key, the parameter and the end
void settle_view_times(const TomlNode& file, TomlNode& root, const Topic& topic, bool quick);

}  // namespace geoprior
