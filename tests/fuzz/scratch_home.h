#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace geoprior::test {

/// Bytes of files by their names below a folder.
using Files = std::map<std::string, std::string>;

/// All regular files below a folder.
Files read_files(const std::filesystem::path& folder);

/// A folder like a clone, deep inside a folder of its own, with some files; it goes when this does.
class ScratchHome {
 public:
  explicit ScratchHome(const Files& files);
  ~ScratchHome();
  ScratchHome(const ScratchHome&) = delete;
  ScratchHome& operator=(const ScratchHome&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return home_; }
  /// What the program says, beside the home.
  [[nodiscard]] std::filesystem::path output() const { return around_ / "output"; }

  /// The first file or folder that is new, gone or changed, but for those in results/.
  [[nodiscard]] std::optional<std::string> change_outside_results() const;
  /// A folder below results/runs in which there is nothing, but for those of a run.
  [[nodiscard]] std::optional<std::string> empty_run_folder() const;

 private:
  [[nodiscard]] Files outside_results() const;

  std::filesystem::path around_;
  std::filesystem::path home_;
  Files before_;
};

}  // namespace geoprior::test
