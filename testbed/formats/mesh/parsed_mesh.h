#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// A surface as a file has it, polygons cut into triangles; nothing is welded, turned or dropped.
struct MeshFile {
  TriMesh mesh;
  Eigen::MatrixX3d velocity;  ///< one row per vertex (units of the file per s), or no rows
  /// Flat coordinates of the vertices: the point array `pattern` of a .vtp, or `vt` of an .obj
  /// whose corners have one each, the same at every corner of a vertex; or no rows.
  Eigen::MatrixX2d pattern = {};
  std::optional<double> time = {};      ///< TimeValue of a .vtp (s)
  std::vector<std::string> notes = {};  ///< what of the file is left out or was changed
};

/// Notes the triangles that a weld left out, if there are any.
inline void note_collapsed(const TriMesh& split, const TriMesh& welded,
                           std::vector<std::string>& notes) {
  if (const Eigen::Index left_out = split.F.rows() - welded.F.rows(); left_out > 0) {
    notes.push_back(std::to_string(left_out) + " triangles with two corners in one place left out");
  }
}

/// Puts the name of the file before each note.
inline void name_notes(MeshFile& mesh, const std::filesystem::path& file) {
  for (std::string& note : mesh.notes) note = file.filename().string() + ": " + note;
}

}  // namespace geoprior
