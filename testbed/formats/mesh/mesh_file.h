#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// Reads a mesh by its extension (any case): `parse_obj`, `parse_ply`, `parse_off`, `parse_stl`,
/// `read_vtp` and `read_pvtp` say what of each format. What of the file is left out stands in its
/// `notes`.
///
/// @throws Error  naming file and line or byte: unreadable, truncated, no finite number, an index
///                out of range, a face of fewer than 3 or more than 256 corners, unknown extension
MeshFile read_mesh_file(const std::filesystem::path& file);
/// The same, its notes with the name of the file. @param warnings  added: the notes
MeshFile read_mesh_file(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// The file, and those that it names as its pieces (.pvtp).
std::vector<std::filesystem::path> files_of_mesh(const std::filesystem::path& file);

/// Extensions that `read_mesh_file` knows: ".obj, .ply, .off, .stl, .vtp, .pvtp".
std::string mesh_file_extensions();
bool is_mesh_file_extension(std::string_view extension);

}  // namespace geoprior
