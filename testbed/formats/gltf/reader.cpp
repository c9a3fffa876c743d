#include "testbed/formats/gltf/reader.h"

#include <Eigen/LU>
#include <limits>

#include "core/error.h"
#include "testbed/formats/gltf/clips.h"
#include "testbed/formats/gltf/container.h"
#include "testbed/formats/gltf/model.h"
#include "testbed/formats/gltf/skin.h"

namespace geoprior {
namespace {

using gltf::Model;

/// Nodes whose mesh is read, and the skin they share.
struct Selection {
  std::vector<std::size_t> nodes;
  std::optional<std::size_t> skin;
};

std::string mesh_names(const Model& model) {
  std::string names;
  for (const gltf::Mesh& mesh : model.meshes) names += (names.empty() ? "" : ", ") + mesh.name;
  return names;
}

Selection select(const Model& model, const GltfReadOptions& options,
                 std::vector<std::string>& ignored) {
  std::vector<std::size_t> candidates;
  for (const std::size_t i : model.node_order) {
    const gltf::Node& node = model.nodes[i];
    if (!node.mesh) continue;
    const bool named = !options.mesh || node.name == *options.mesh ||
                       model.meshes[*node.mesh].name == *options.mesh;
    if (named) candidates.push_back(i);
  }
  if (candidates.empty() && options.mesh)
    throw Error("no mesh '" + *options.mesh + "'", model.file.string(), mesh_names(model));
  if (candidates.empty()) throw Error("no node has a mesh", model.file.string());
  Selection selection;
  for (const std::size_t i : candidates) {
    if (!selection.skin) selection.skin = model.nodes[i].skin;
  }
  for (const std::size_t i : candidates) {
    if (model.nodes[i].skin == selection.skin) selection.nodes.push_back(i);
  }
  std::size_t others = 0;
  for (const gltf::Node& node : model.nodes) others += node.mesh ? 1 : 0;
  others -= selection.nodes.size();
  if (others > 0) ignored.push_back(std::to_string(others) + " other mesh(es)");
  return selection;
}

/// Corner triples of a primitive, from its mode.
std::vector<std::array<std::uint32_t, 3>> triangles_of(const std::vector<std::uint32_t>& indices,
                                                       int mode, const std::string& where) {
  static constexpr std::array<const char*, 4> kNames{"points", "lines", "line loop", "line strip"};
  if (mode < 4) {
    throw Error("primitive mode " + std::to_string(mode) + " (" + kNames[mode] + ")", where,
                "triangles, triangle strip, triangle fan (4, 5, 6)");
  }
  if (mode == 4 && indices.size() % 3 != 0)
    throw Error(std::to_string(indices.size()) + " corners of triangles", where, "a multiple of 3");
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (mode == 4) {
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
      triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  } else {
    for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
      if (mode == 6) {
        triangles.push_back({indices[0], indices[i + 1], indices[i + 2]});
      } else {
        triangles.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
      }
    }
  }
  return triangles;
}

/// Growing arrays of the mesh that is read.
struct Builder {
  std::vector<Eigen::MatrixXd> positions;
  int vertex_count = 0;
  std::vector<std::array<int, 3>> triangles;
  std::vector<Eigen::Triplet<double>> influences;
  bool renormalised = false;
};

Eigen::MatrixXd read_positions(const Model& model, const gltf::Primitive& primitive,
                               const std::string& where) {
  const auto it = primitive.attributes.find("POSITION");
  if (it == primitive.attributes.end()) throw Error("no POSITION", where);
  if (model.accessors[it->second].columns != 3 || model.accessors[it->second].is_matrix)
    throw Error("POSITION is not VEC3", where);
  Eigen::MatrixXd positions = gltf::decode(model, it->second);
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    if (!positions.row(v).allFinite())
      throw Error("position is not finite", where + ", vertex " + std::to_string(v));
  }
  return positions;
}

void add_primitive(const Model& model, const gltf::Primitive& primitive, const std::string& where,
                   const Eigen::Affine3d& to_rest, const gltf::SkinData* skin, Builder& builder) {
  Eigen::MatrixXd positions = read_positions(model, primitive, where);
  const std::size_t count = positions.rows();
  constexpr std::size_t kMax = std::numeric_limits<int>::max();
  if (count > kMax - builder.vertex_count) throw Error("more than 2^31 vertices", where);
  std::vector<std::uint32_t> indices;
  if (primitive.indices) {
    if (!model.accessors[*primitive.indices].view) throw Error("the indices have no data", where);
    indices = gltf::decode_indices(model, *primitive.indices);
  } else {
    for (std::uint32_t i = 0; i < count; ++i) indices.push_back(i);
  }
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] >= count) {
      throw Error("index " + std::to_string(indices[i]) + " at place " + std::to_string(i) +
                      " is out of range",
                  where, "0 to " + std::to_string(count - 1));
    }
  }
  const bool mirrored = to_rest.linear().determinant() < 0;
  for (auto t : triangles_of(indices, primitive.mode, where)) {
    if (mirrored) std::swap(t[1], t[2]);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;  // strips restart so
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = builder.vertex_count + static_cast<int>(t[k]);
    builder.triangles.push_back(corners);
  }
  if (skin != nullptr) {
    gltf::read_influences(model, primitive, where, *skin, static_cast<int>(count),
                          builder.vertex_count, builder.influences, builder.renormalised);
  }
  positions =
      (positions * to_rest.linear().transpose()).rowwise() + to_rest.translation().transpose();
  if (!positions.allFinite()) throw Error("positions overflow in the scene", where);
  builder.positions.push_back(std::move(positions));
  builder.vertex_count += static_cast<int>(count);
}

TriMesh finish_mesh(const Builder& builder, const std::string& file) {
  if (builder.triangles.empty()) throw Error("the meshes have no triangles", file);
  TriMesh mesh;
  mesh.V.resize(builder.vertex_count, 3);
  Eigen::Index row = 0;
  for (const Eigen::MatrixXd& block : builder.positions) {
    mesh.V.middleRows(row, block.rows()) = block;
    row += block.rows();
  }
  mesh.F.resize(builder.triangles.size(), 3);
  for (std::size_t f = 0; f < builder.triangles.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) mesh.F(f, k) = builder.triangles[f][k];
  }
  return mesh;
}

/// Nodes renumbered so that parents come first; returns the new number of each node of the model.
std::vector<int> renumber_nodes(const Model& model, GltfBinding& binding) {
  std::vector<int> number(model.nodes.size(), -1);
  for (const std::size_t i : model.node_order) {
    const gltf::Node& node = model.nodes[i];
    number[i] = static_cast<int>(binding.nodes.size());
    binding.nodes.push_back({node.parent ? number[*node.parent] : -1, node.matrix, node.translation,
                             node.rotation, node.scale});
  }
  return number;
}

void note_attributes(const gltf::Primitive& primitive, std::vector<std::string>& ignored) {
  const auto add = [&](const std::string& what) {
    if (std::find(ignored.begin(), ignored.end(), what) == ignored.end()) ignored.push_back(what);
  };
  for (const auto& [name, index] : primitive.attributes) {
    if (name != "POSITION" && !name.starts_with("JOINTS_") && !name.starts_with("WEIGHTS_"))
      add("attribute " + name.substr(0, 40));
  }
  if (primitive.has_targets) add("morph targets");
}

void warn(const Model& model, const std::vector<std::string>& ignored, bool renormalised,
          GltfCharacter& character) {
  std::string list;
  for (const std::string& what : ignored) list += (list.empty() ? "" : ", ") + what;
  if (!list.empty()) character.warnings.push_back(model.file.string() + ": ignored: " + list);
  if (renormalised)
    character.warnings.push_back(model.file.string() +
                                 ": weights that did not sum to 1 were scaled");
}

GltfCharacter make_character(const Model& model, const GltfReadOptions& options) {
  GltfCharacter character;
  std::vector<std::string> ignored = model.ignored;
  const Selection selection = select(model, options, ignored);
  std::optional<gltf::SkinData> skin;
  if (selection.skin) skin = gltf::read_skin(model, *selection.skin);
  const auto world = gltf::world_transforms(model);
  Builder builder;
  for (const std::size_t node : selection.nodes) {
    const std::size_t mesh = *model.nodes[node].mesh;
    for (std::size_t p = 0; p < model.meshes[mesh].primitives.size(); ++p) {
      const gltf::Primitive& primitive = model.meshes[mesh].primitives[p];
      note_attributes(primitive, ignored);
      add_primitive(
          model, primitive,
          place(model, "/meshes/" + std::to_string(mesh) + "/primitives/" + std::to_string(p)),
          skin ? skin->to_rest : world[node], skin ? &*skin : nullptr, builder);
    }
  }
  character.mesh = finish_mesh(builder, model.file.string());
  const std::vector<int> number = renumber_nodes(model, character.binding);
  if (skin) {
    character.weights.resize(builder.vertex_count, skin->skeleton.size());
    character.weights.setFromTriplets(builder.influences.begin(), builder.influences.end());
    for (const std::size_t node : skin->node_of_joint)
      character.binding.joint_node.push_back(number[node]);
    character.binding.from_rest = skin->from_rest;
    character.skeleton = std::move(skin->skeleton);
    validate(character.weights, builder.vertex_count, character.skeleton->size());
  }
  character.clips = gltf::read_clips(model, number, ignored);
  warn(model, ignored, builder.renormalised, character);
  return character;
}

}  // namespace

GltfCharacter read_gltf(const std::filesystem::path& file, const GltfReadOptions& options) {
  const Model model = gltf::parse_gltf(file);
  GltfCharacter character = make_character(model, options);
  character.files.push_back(file);
  for (const gltf::Buffer& buffer : model.buffers) {
    if (buffer.file) character.files.push_back(*buffer.file);
  }
  return character;
}

GltfCharacter read_gltf_bytes(const std::vector<std::byte>& bytes,
                              const std::filesystem::path& name, const GltfReadOptions& options) {
  return make_character(gltf::parse_gltf(bytes, name, false), options);
}

}  // namespace geoprior
