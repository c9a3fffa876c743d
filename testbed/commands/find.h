#pragma once

#include <filesystem>
#include <string>

namespace geoprior {

/// The file of an identifier of the catalogue, or a file that is named itself.
/// @throws Error  naming identifiers that are near
std::filesystem::path experiment_file(const std::string& id_or_file);

/// The folder of a finished run: a folder, its run.h5, or an experiment's newest run.
/// @throws Error  saying how to make the run
std::filesystem::path run_folder_of(const std::string& run);

}  // namespace geoprior
