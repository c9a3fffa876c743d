#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace geoprior {

/// A frame's file before its time is settled.
struct FoundFile {
  std::filesystem::path file;
  int number = 0;                                   ///< in its name, or in the list of a .pvd
  std::optional<double> time;                       ///< s, that a .pvd says
  std::vector<std::filesystem::path> further = {};  ///< parts of the same frame
};

/// The files that a path means, in order; what the search noticed.
struct FoundFiles {
  std::vector<FoundFile> files;
  std::vector<std::string> warnings;
  std::optional<std::filesystem::path> collection;  ///< the .pvd that was read
};

/// Numbered files ("wave_%04d.ply": exactly so many digits, or more without a leading zero; "%d":
/// any), in order of number. A number below zero has its sign as one of the digits ("-001", as C
/// prints it) or before them ("-0001", as Blender does).
/// @throws Error  for a pattern without or with two numbers, that nothing matches (says what is
///                there), or that two files match with one number
FoundFiles find_pattern(const std::filesystem::path& pattern);
/// The same, whatever the files are by their extension.
FoundFiles find_numbered(const std::filesystem::path& pattern);
/// Whether `find_pattern` would find anything.
bool matches_any(const std::filesystem::path& pattern);

/// The numbered meshes of a folder; `part` chooses between several ("surface_0000.vtp" is of the
/// part surface). A minus behind "_", "." or a blank is the sign of the number. Times come from the
/// .pvd of that name beside the folder, which runs have.
FoundFiles find_in_folder(const std::filesystem::path& folder, const std::string& part);

/// The files of a ParaView collection (.pvd) or file series (.vtp.series), in order of time; of the
/// name `part` where it has several. Files of one time whose numbers of the part differ are one
/// frame, in that order; a frame that lacks one of them is left out.
/// @throws Error  naming file and byte: no XML, no collection, a time that is no number
FoundFiles find_in_collection(const std::filesystem::path& file, const std::string& part);

}  // namespace geoprior
