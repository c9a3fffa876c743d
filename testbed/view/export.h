#pragma once

#include <filesystem>
#include <string>

namespace geoprior {

/// Writes every frame of every variant below `out` as obj, ply or one animated glb a variant.
void export_run(const std::filesystem::path& run_folder, const std::string& format,
                const std::filesystem::path& out);

}  // namespace geoprior
