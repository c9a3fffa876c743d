#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace geoprior::gltf {

/// JSON text and binary chunk of a .glb, or the text alone of a .gltf.
struct Container {
  std::string json;
  std::vector<std::byte> binary;
  bool has_binary = false;
};

/// Splits a file's bytes; a binary file is known by its magic number, not by its name.
/// @throws Error  on a truncated or malformed .glb, naming the byte
Container split_container(const std::vector<std::byte>& bytes, const std::filesystem::path& file);

/// Bytes behind the URI of a buffer: a base64 data URI or a file below the folder of `file`.
/// @throws Error  naming `where` for any other scheme, absolute paths and paths that leave the
/// folder
std::vector<std::byte> load_uri(const std::string& uri, const std::filesystem::path& file,
                                const std::string& where, bool other_files_allowed);

/// Bytes of a whole file.
std::vector<std::byte> read_bytes(const std::filesystem::path& file);

}  // namespace geoprior::gltf
