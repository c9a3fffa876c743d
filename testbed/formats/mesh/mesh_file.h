#pragma once

#include <filesystem>
#include <string>

#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// Reads .obj, .ply, .off or .vtp by extension (any case).
///
/// - OBJ: `v` and `f`; corners `v/vt/vn` share the position, negative indices count from the end.
/// - PLY: ascii or binary of either byte order; velocities as vx vy vz or velocity_0 … velocity_2;
///   other elements and properties are skipped.
/// - OFF: with or without colours and normals of the vertices, ascii.
/// - VTP: polygons and strips; velocities as the point array `velocity`.
///
/// @throws Error  naming file and line or byte: unreadable, truncated, no finite number, an index
///                out of range, a face of fewer than 3 or more than 256 corners, unknown extension
MeshFile read_mesh_file(const std::filesystem::path& file);

/// Extensions that `read_mesh_file` knows: ".obj, .ply, .off, .vtp".
std::string mesh_file_extensions();
bool is_mesh_file_extension(std::string extension);

}  // namespace geoprior
