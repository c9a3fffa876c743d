#pragma once

#include <filesystem>
#include <string>

namespace geoprior {

/// A folder with experiments/, data/ and results/: a clone, or what was installed.
struct Home {
  std::filesystem::path folder;
  bool installed = false;  ///< it belongs to the system: nothing is written there
};

/// The home of a program: <prefix>/share/geoprior of <prefix>/bin/geoprior, else the clone above
/// it.
/// @throws Error  when there is neither
Home home_of(const std::filesystem::path& program);

/// What is read: GEOPRIOR_HOME, else the home of the running program.
std::filesystem::path geoprior_home();

/// Where results/runs and data/banks are written: the same folder, but of an installed program the
/// user's own, $XDG_DATA_HOME/geoprior (~/.local/share/geoprior). It need not exist.
std::filesystem::path writable_home();

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
