#include "testbed/external/part_file.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/gltf/reader.h"
#include "testbed/formats/input_file.h"
#include "testbed/formats/mesh/obj_reader.h"
#include "testbed/formats/mesh/ply_reader.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/joined.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> kPartExtensions{".vtp", ".vti", ".ply",
                                                          ".obj", ".glb", ".gltf"};

Part surface_of(TriMesh mesh) {
  Part part;
  part.points = std::move(mesh.V);
  part.triangles = std::move(mesh.F);
  return part;
}

}  // namespace

bool is_part_extension(std::string_view extension) {
  return std::find(kPartExtensions.begin(), kPartExtensions.end(), extension) !=
         kPartExtensions.end();
}

std::string part_extensions() { return joined(kPartExtensions); }

Part read_part_file(const fs::path& file, std::optional<double>& parameter) {
  parameter.reset();
  require_regular_file(file);
  const std::string extension = file.extension().string(), name = file.string();
  if (extension == ".vtp" || extension == ".vti") return read_foreign_vtk_part(file, parameter);
  if (extension == ".glb" || extension == ".gltf") return surface_of(read_gltf(file).mesh);
  const std::string bytes = read_whole_file(file);
  if (extension == ".ply") return parse_ply_part(bytes, name);
  if (extension == ".obj") return surface_of(parse_obj(bytes, name).mesh);
  throw Error("unknown extension '" + extension + "'", name, part_extensions());
}

}  // namespace geoprior
