#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/mesh.h"

namespace geoprior {

/// A surface as a file has it, polygons cut into triangles; nothing is welded, turned or dropped.
struct MeshFile {
  TriMesh mesh;
  Eigen::MatrixX3d velocity;  ///< one row per vertex (units of the file per s), or no rows
  /// Flat coordinates of the vertices: the point array `pattern` of a .vtp, or `vt` of an .obj
  /// whose corners have one each, the same at every corner of a vertex; or no rows.
  Eigen::MatrixX2d pattern = {};
  std::optional<double> time = {};  ///< TimeValue of a .vtp (s)
};

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
