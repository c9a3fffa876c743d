#pragma once

#include <unistd.h>

#include <filesystem>

namespace geoprior::test {

/// Where scratch folders are made: in memory where the system has such a place, because runs flush
/// every file to the disk, else in the folder for temporary files.
inline std::filesystem::path scratch_place() {
  const std::filesystem::path memory = "/dev/shm";
  return ::access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
}

}  // namespace geoprior::test
