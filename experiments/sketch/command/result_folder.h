#pragma once

#include <filesystem>
#include <optional>

#include "testbed/formats/folders.h"

namespace geoprior::sketch {

/// A folder of results that is filled when all of them are there: they are made in a folder inside
/// of it that has a temporary name, and moved up by `commit`. What does not come so far (an
/// exception, Ctrl-C) leaves nothing.
class ResultFolder {
 public:
  /// @throws Error  naming the folder: it is a file, it has something in it already, or no folder
  ///                can be made in it
  explicit ResultFolder(std::filesystem::path folder);
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
  /// Where results are made.
  [[nodiscard]] const std::filesystem::path& unfinished() const { return unfinished_; }
  /// @param last  of the files, by which the others are known to be whole
  /// @throws Error  naming what another program has put there meanwhile
  void commit(const std::filesystem::path& last);
  /// Removes what is unfinished, and the folders that were made for it.
  void discard() noexcept;

 private:
  std::filesystem::path folder_, unfinished_;
  std::optional<MadeFolders> made_;
};

/// `parent`/<stem>-sketch, or the first of <stem>-sketch-2, … that is not there.
std::filesystem::path unused_result_folder(const std::filesystem::path& drawing);

}  // namespace geoprior::sketch
