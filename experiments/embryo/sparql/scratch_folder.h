#pragma once

#include <filesystem>

namespace geoprior::embryo {

/// A folder for temporary files that goes with its object, whatever is in it.
class ScratchFolder {
 public:
  /// @throws Error  when none can be made
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace geoprior::embryo
