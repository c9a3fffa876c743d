#pragma once

#include <filesystem>
#include <string>

#include "testbed/runner/opened_run.h"

namespace geoprior {

/// Writes every frame of every variant below `out` as obj, ply or one animated glb a variant.
void export_run(const OpenedRun& run, const std::string& format, const std::filesystem::path& out);

}  // namespace geoprior
