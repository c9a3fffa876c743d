#include "testbed/formats/mesh/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/mesh/named_files.h"
#include "testbed/formats/mesh/obj_reader.h"
#include "testbed/formats/mesh/off_reader.h"
#include "testbed/formats/mesh/ply_reader.h"
#include "testbed/formats/mesh/stl_reader.h"
#include "testbed/formats/mesh/vtp_reader.h"

namespace geoprior {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

constexpr std::array<std::string_view, 6> kMeshExtensions{".obj", ".ply",  ".off",
                                                          ".vtp", ".pvtp", ".stl"};

}  // namespace

std::string mesh_file_extensions() { return ".obj, .ply, .off, .stl, .vtp, .pvtp"; }

bool is_mesh_file_extension(std::string extension) {
  return std::find(kMeshExtensions.begin(), kMeshExtensions.end(), lower(std::move(extension))) !=
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
  for (const std::string& note : read.notes)
    warnings.push_back(file.filename().string() + ": " + note);
  return read;
}

}  // namespace geoprior
