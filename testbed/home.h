#pragma once

#include <filesystem>
#include <string>

namespace geoprior {

/// Root of the clone: where experiments/ and results/ are found, above the executable.
std::filesystem::path geoprior_home();

/// A file named in an experiment: absolute, relative to the folder of the experiment's file, or to
/// a folder of the clone ("data").
/// @param where  key that names it, for the message
/// @throws Error  naming the places looked at
std::filesystem::path find_file(const std::string& name, const std::filesystem::path& folder,
                                const std::filesystem::path& of_clone, const std::string& where);

/// A folder named in an experiment, looked for in the same places.
/// @throws Error  naming the places looked at, or the file that has the name
std::filesystem::path find_folder(const std::string& name, const std::filesystem::path& folder,
                                  const std::filesystem::path& of_clone, const std::string& where);

}  // namespace geoprior
