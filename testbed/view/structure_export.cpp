#include "testbed/view/structure_export.h"

#include <algorithm>
#include <map>

#include "testbed/formats/gltf/switched_meshes.h"
#include "testbed/formats/vtk/value_names.h"
#include "testbed/view/figure/colors.h"

namespace geoprior {
namespace {

constexpr const char* kStructure = "structure";
constexpr const char* kKind = "kind";

const NamedArray* named_cells(const Part& part, const char* name) {
  const NamedArray* array = part.find_array(name, NamedArray::On::cells);
  return array == nullptr || array->names.empty() ? nullptr : array;
}

/// The names of all frames, each once; frames need not have the same codes.
class NameList {
 public:
  NameList(const std::vector<Part>& frames, const char* array, const std::string& where) {
    for (const Part& part : frames) {
      const NamedArray* cells = named_cells(part, array);
      if (cells == nullptr) continue;
      require_codes(*cells, where);
      for (const std::string& name : cells->names) {
        if (index_.emplace(name, names_.size()).second) names_.push_back(name);
      }
    }
  }

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Where the name of a triangle stands in the list; 0 without names.
  [[nodiscard]] int of(const NamedArray* cells, Eigen::Index triangle) const {
    if (cells == nullptr) return 0;
    return index_.at(cells->names[static_cast<std::size_t>(cells->values(triangle, 0))]);
  }

 private:
  std::vector<std::string> names_;
  std::map<std::string, int> index_;
};

std::vector<GltfMaterial> materials_of(const NameList& kinds) {
  constexpr std::array<double, 3> kClay{0.86, 0.72, 0.63};
  if (kinds.names().empty()) return {{"clay", kClay}};
  const Palette palette = class_palette(kinds.names().size(), false);
  std::vector<GltfMaterial> materials;
  for (std::size_t i = 0; i < palette.size(); ++i)
    materials.push_back({kinds.names()[i], palette[i]});
  return materials;
}

/// Some triangles of a part, with the vertices that they have.
GltfPiece piece_of(const Part& part, const Eigen::MatrixX3d& normals,
                   const std::vector<Eigen::Index>& triangles, int material) {
  std::vector<int> own(part.points.rows(), -1);
  std::vector<int> vertices;
  GltfPiece piece;
  piece.material = material;
  piece.mesh.F.resize(std::ssize(triangles), 3);
  for (int t = 0; t < std::ssize(triangles); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = part.triangles(triangles[t], k);
      if (own[vertex] < 0) {
        own[vertex] = static_cast<int>(vertices.size());
        vertices.push_back(vertex);
      }
      piece.mesh.F(t, k) = own[vertex];
    }
  }
  piece.mesh.V = part.points(vertices, Eigen::all);
  piece.normals = normals(vertices, Eigen::all);
  return piece;
}

void add_frame(const Part& part, std::size_t frame, const NameList& structures,
               const NameList& kinds, std::vector<GltfSwitched>& things) {
  if (part.triangles.rows() == 0) return;
  const NamedArray* structure = named_cells(part, kStructure);
  const NamedArray* kind = named_cells(part, kKind);
  std::map<std::pair<int, int>, std::vector<Eigen::Index>> groups;
  for (Eigen::Index t = 0; t < part.triangles.rows(); ++t)
    groups[{structures.of(structure, t), kinds.of(kind, t)}].push_back(t);
  const Eigen::MatrixX3d normals = vertex_normals({part.points, part.triangles});
  for (const auto& [group, triangles] : groups)
    things[group.first].frames[frame].push_back(piece_of(part, normals, triangles, group.second));
}

}  // namespace

bool have_structures(const std::vector<Part>& frames) {
  const auto is_empty = [](const Part& part) { return part.triangles.rows() == 0; };
  return std::all_of(frames.begin(), frames.end(),
                     [&](const Part& part) {
                       return part.kind == Part::Kind::triangles &&
                              (is_empty(part) || named_cells(part, kStructure) != nullptr);
                     }) &&
         !std::all_of(frames.begin(), frames.end(), is_empty);
}

std::string structures_glb(const std::vector<Part>& frames, const std::vector<double>& times_s,
                           const std::string& name) {
  const NameList structures(frames, kStructure, name), kinds(frames, kKind, name);
  std::vector<GltfSwitched> things;
  for (const std::string& structure : structures.names())
    things.push_back({structure, std::vector<std::vector<GltfPiece>>(frames.size())});
  for (std::size_t i = 0; i < frames.size(); ++i)
    add_frame(frames[i], i, structures, kinds, things);
  return switched_meshes_glb(things, materials_of(kinds), times_s, name);
}

}  // namespace geoprior
