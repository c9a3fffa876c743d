#include "testbed/formats/mesh/vtp_reader.h"

#include <algorithm>
#include <limits>
#include <pugixml.hpp>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/text/nesting.h"
#include "testbed/formats/text/text_file.h"
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

fs::path named_in(const fs::path& file, const std::string& name) {
  const auto beside = [&](const fs::path& given) {
    return given.is_absolute() ? given : file.parent_path() / given;
  };
  const fs::path found = beside(name);
  if (name.find('\\') == std::string::npos || fs::exists(found)) return found;
  std::string with_slashes = name;
  std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
  return beside(with_slashes).lexically_normal();
}

std::vector<fs::path> parse_pvtp(std::string_view text, const fs::path& file) {
  const std::string name = file.string();
  require_shallow_xml(text, name);
  pugi::xml_document document;
  const auto result = document.load_buffer(text.data(), text.size());
  if (!result) {
    throw Error(std::string("is no valid XML: ") + result.description(),
                name + ", byte " + std::to_string(result.offset));
  }
  const pugi::xml_node pieces = document.child("VTKFile").child("PPolyData");
  if (!pieces) throw Error("holds no PPolyData", name, "VTKFile type=\"PPolyData\"");
  std::vector<fs::path> files;
  for (const pugi::xml_node piece : pieces.children("Piece")) {
    const std::string source = piece.attribute("Source").as_string();
    if (source.empty()) {
      throw Error("Piece without a Source",
                  name + ", byte " + std::to_string(piece.offset_debug()));
    }
    files.push_back(named_in(file, source));
    if (files.back().extension() != ".vtp") {
      throw Error("names a piece with the extension '" + files.back().extension().string() + "'",
                  name + ", byte " + std::to_string(piece.offset_debug()), ".vtp");
    }
  }
  if (files.empty()) throw Error("names no piece", name, "<Piece Source=\"name_0.vtp\"/>");
  return files;
}

std::vector<fs::path> pvtp_pieces(const fs::path& file) {
  return parse_pvtp(read_text_file(file), file);
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
    if (!fs::is_regular_file(piece))
      throw Error("names a piece that is not there", file.string(), piece.string());
    parts.push_back(read_vtp(piece));
    for (std::string& note : parts.back().notes) note = piece.filename().string() + ": " + note;
  }
  return joined(std::move(parts));
}

}  // namespace geoprior
