#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// VTP: polygons and strips; velocities as the point array `velocity`, coordinates of a pattern as
/// `pattern`. What else it has is left out and noted. @throws Error  as `read_mesh_file`
MeshFile read_vtp(const std::filesystem::path& file);

/// PVTP: the pieces that it names, one surface (`joined`). Their ghost cells are left out.
/// @throws Error  as `read_mesh_file`
MeshFile read_pvtp(const std::filesystem::path& file);

/// The files of the pieces of a .pvtp, beside it unless they are absolute.
/// @throws Error  naming file and byte: no XML, no pieces, a piece without a file
std::vector<std::filesystem::path> pvtp_pieces(const std::filesystem::path& file);
std::vector<std::filesystem::path> parse_pvtp(std::string_view text,
                                              const std::filesystem::path& file);

/// Where a file lies that another one names: beside it unless it is absolute. Backslashes part
/// folders, as Windows writes them, unless there is a file with them in its name.
std::filesystem::path named_in(const std::filesystem::path& file, const std::string& name);

/// Surfaces one after the other, as one. Velocities, and coordinates of the pattern, that one of
/// them lacks are left out and noted.
MeshFile joined(std::vector<MeshFile> parts);

}  // namespace geoprior
