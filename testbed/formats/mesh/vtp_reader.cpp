#include "testbed/formats/mesh/vtp_reader.h"

#include <algorithm>
#include <limits>
#include <system_error>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/mesh/named_files.h"
#include "testbed/formats/vtk/files.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

/// Rows below each other; none when a part with vertices has none.
template <int columns>
Eigen::Matrix<double, Eigen::Dynamic, columns> stacked(
    const std::vector<MeshFile>& parts,
    Eigen::Matrix<double, Eigen::Dynamic, columns> MeshFile::*rows, Eigen::Index vertices,
    const char* what, std::vector<std::string>& notes) {
  Eigen::Matrix<double, Eigen::Dynamic, columns> all(vertices, columns);
  Eigen::Index at = 0;
  bool some = false;
  for (const MeshFile& part : parts) {
    const auto& own = part.*rows;
    some = some || own.rows() > 0;
    if (own.rows() != part.mesh.V.rows()) continue;
    all.middleRows(at, own.rows()) = own;
    at += own.rows();
  }
  if (at == vertices) return all;
  if (some) notes.push_back(std::string(what) + " left out: not every part has them");
  return {};
}

}  // namespace

MeshFile read_vtp(const fs::path& file) {
  VtkFile read = parse_foreign_vtk_file(read_whole_file(file), ".vtp", file.string());
  Part& part = read.part;
  if (part.kind != Part::Kind::triangles && part.points.rows() > 0) {
    throw Error("holds no surface", file.string(), "polygons or strips");
  }
  MeshFile out;
  out.time = read.parameter;
  out.notes = std::move(read.notes);
  for (const NamedArray& array : part.arrays) {
    if (array.on != NamedArray::On::points || array.values.rows() != part.points.rows()) continue;
    if (array.name == "velocity" && array.values.cols() == 3) out.velocity = array.values;
    if (array.name == "pattern" && array.values.cols() == 2) out.pattern = array.values;
  }
  out.mesh = {std::move(part.points), std::move(part.triangles)};
  return out;
}

MeshFile joined(std::vector<MeshFile> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  MeshFile all;
  Eigen::Index vertices = 0, triangles = 0;
  for (const MeshFile& part : parts) {
    vertices += part.mesh.V.rows();
    triangles += part.mesh.F.rows();
    if (!all.time) all.time = part.time;
    for (const std::string& note : part.notes) {
      if (std::find(all.notes.begin(), all.notes.end(), note) == all.notes.end())
        all.notes.push_back(note);
    }
  }
  if (vertices > std::numeric_limits<int>::max()) throw Error("the parts have too many vertices");
  all.mesh = {Eigen::MatrixX3d(vertices, 3), Eigen::MatrixX3i(triangles, 3)};
  Eigen::Index v = 0, t = 0;
  for (const MeshFile& part : parts) {
    all.mesh.V.middleRows(v, part.mesh.V.rows()) = part.mesh.V;
    all.mesh.F.middleRows(t, part.mesh.F.rows()) = part.mesh.F.array() + static_cast<int>(v);
    v += part.mesh.V.rows();
    t += part.mesh.F.rows();
  }
  all.velocity = stacked<3>(parts, &MeshFile::velocity, vertices, "velocities", all.notes);
  all.pattern =
      stacked<2>(parts, &MeshFile::pattern, vertices, "coordinates of the pattern", all.notes);
  return all;
}

MeshFile read_pvtp(const fs::path& file) {
  std::vector<MeshFile> parts;
  for (const fs::path& piece : pvtp_pieces(file)) {
    std::error_code unknown;
    if (!fs::is_regular_file(piece, unknown))
      throw Error("names a piece that is not there", file.string(), piece.string());
    parts.push_back(read_vtp(piece));
    name_notes(parts.back(), piece);
  }
  return joined(std::move(parts));
}

}  // namespace geoprior
