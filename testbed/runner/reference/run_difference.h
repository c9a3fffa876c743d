#pragma once

#include <string>
#include <vector>

#include "testbed/runner/opened_run.h"

namespace geoprior {

/// How the frames of a run differ from those of another, a line for each variant that has other
/// files: how many frames differ, at which parameter the first, and how far the points of its parts
/// have moved at most, over all frames. Frames are those of equal parameter.
/// @throws Error  naming a recorded file that is missing or damaged
std::vector<std::string> frame_differences(const OpenedRun& now, const OpenedRun& before);

}  // namespace geoprior
