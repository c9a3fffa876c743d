#pragma once

#include <filesystem>
#include <vector>

namespace geoprior {

/// A file or folder below `folder`, found without following a symbolic link: what is written, read
/// or removed by this path lies inside. `folder` itself may be one, or lie below one. The last
/// component may be missing, as may any before it.
///
/// @param relative  names, none of them "..", not absolute
/// @throws Error  naming the link; or when `relative` leaves the folder
std::filesystem::path path_below(const std::filesystem::path& folder,
                                 const std::filesystem::path& relative);

/// What is directly in a folder, sorted by name; nothing where there is no such folder.
std::vector<std::filesystem::path> sorted_entries(const std::filesystem::path& folder);

/// Folders made for output. Those that are still empty go with this object: what is refused leaves
/// no folder that was not there before.
class MadeFolders {
 public:
  MadeFolders() = default;
  /// Makes `folder` and the parents it lacks. @throws Error  as make_folders
  explicit MadeFolders(const std::filesystem::path& folder);
  ~MadeFolders();
  MadeFolders(MadeFolders&&) noexcept = default;
  MadeFolders& operator=(MadeFolders&& other) noexcept;
  MadeFolders(const MadeFolders&) = delete;
  MadeFolders& operator=(const MadeFolders&) = delete;

 private:
  void remove_empty();

  std::vector<std::filesystem::path> made_;  ///< outermost first
};

}  // namespace geoprior
