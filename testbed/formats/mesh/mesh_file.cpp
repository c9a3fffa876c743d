#include "testbed/formats/mesh/mesh_file.h"

#include <algorithm>
#include <cctype>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/mesh/obj_reader.h"
#include "testbed/formats/mesh/off_reader.h"
#include "testbed/formats/mesh/ply_reader.h"
#include "testbed/formats/vtk/files.h"

namespace geoprior {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

MeshFile read_vtp(const std::filesystem::path& file) {
  MeshFile out;
  Part part = parse_foreign_vtk_part(read_whole_file(file), ".vtp", file.string(), out.time);
  if (part.kind != Part::Kind::triangles && part.points.rows() > 0) {
    throw Error("holds no surface", file.string(), "polygons or strips");
  }
  for (const NamedArray& array : part.arrays) {
    if (array.on != NamedArray::On::points || array.values.rows() != part.points.rows()) continue;
    if (array.name == "velocity" && array.values.cols() == 3) out.velocity = array.values;
    if (array.name == "pattern" && array.values.cols() == 2) out.pattern = array.values;
  }
  out.mesh = {std::move(part.points), std::move(part.triangles)};
  return out;
}

}  // namespace

std::string mesh_file_extensions() { return ".obj, .ply, .off, .vtp"; }

bool is_mesh_file_extension(std::string extension) {
  extension = lower(std::move(extension));
  return extension == ".obj" || extension == ".ply" || extension == ".off" || extension == ".vtp";
}

MeshFile read_mesh_file(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string extension = lower(file.extension().string());
  if (!is_mesh_file_extension(extension)) {
    throw Error("has the extension '" + extension + "'", name, mesh_file_extensions());
  }
  if (!std::filesystem::is_regular_file(file)) throw Error("is no file", name);
  if (extension == ".vtp") return read_vtp(file);
  const std::string bytes = read_whole_file(file);
  if (extension == ".obj") return parse_obj(bytes, name);
  return extension == ".ply" ? parse_ply(bytes, name) : parse_off(bytes, name);
}

}  // namespace geoprior
