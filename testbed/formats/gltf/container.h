#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
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

/// The file that the URI of a buffer names, below the folder of `file`; absent for a data URI.
/// @throws Error  naming `where` for any other scheme, absolute paths, paths that leave the folder
/// and files that are not there
std::optional<std::filesystem::path> file_of_uri(const std::string& uri,
                                                 const std::filesystem::path& file,
                                                 const std::string& where);

/// Bytes of a base64 data URI.
/// @throws Error  naming `where` for anything else
std::vector<std::byte> decode_data_uri(const std::string& uri, const std::string& where);

/// Bytes of a whole file.
std::vector<std::byte> read_bytes(const std::filesystem::path& file);

}  // namespace geoprior::gltf
