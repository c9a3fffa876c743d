#include "testbed/formats/mesh/mesh_file.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/mesh/named_files.h"
#include "testbed/formats/mesh/obj_reader.h"
#include "testbed/formats/mesh/off_reader.h"
#include "testbed/formats/mesh/ply_reader.h"
#include "testbed/formats/mesh/stl_reader.h"
#include "testbed/formats/mesh/vtp_reader.h"
#include "testbed/formats/text/letters.h"
#include "testbed/joined.h"

namespace geoprior {
namespace {

constexpr std::array<std::string_view, 6> kMeshExtensions{".obj", ".ply", ".off",
                                                          ".stl", ".vtp", ".pvtp"};

}  // namespace

std::string mesh_file_extensions() { return joined(kMeshExtensions); }

bool is_mesh_file_extension(std::string_view extension) {
  return std::find(kMeshExtensions.begin(), kMeshExtensions.end(), lower(extension)) !=
         kMeshExtensions.end();
}

std::vector<std::filesystem::path> files_of_mesh(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files{file};
  if (lower(file.extension().string()) != ".pvtp") return files;
  const std::vector<std::filesystem::path> pieces = pvtp_pieces(file);
  files.insert(files.end(), pieces.begin(), pieces.end());
  return files;
}

MeshFile read_mesh_file(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string extension = lower(file.extension().string());
  if (!is_mesh_file_extension(extension)) {
    throw Error("has the extension '" + extension + "'", name, mesh_file_extensions());
  }
  if (!std::filesystem::is_regular_file(file)) throw Error("is no file", name);
  if (extension == ".vtp") return read_vtp(file);
  if (extension == ".pvtp") return read_pvtp(file);
  const std::string bytes = read_whole_file(file);
  if (extension == ".obj") return parse_obj(bytes, name);
  if (extension == ".stl") return parse_stl(bytes, name);
  return extension == ".ply" ? parse_ply(bytes, name) : parse_off(bytes, name);
}

MeshFile read_mesh_file(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  MeshFile read = read_mesh_file(file);
  name_notes(read, file);
  warnings.insert(warnings.end(), read.notes.begin(), read.notes.end());
  return read;
}

}  // namespace geoprior
