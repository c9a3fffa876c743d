#include "testbed/formats/gltf/reader.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <sstream>

#include "core/error.h"
#include "testbed/formats/gltf/clips.h"
#include "testbed/formats/gltf/container.h"
#include "testbed/formats/gltf/model.h"
#include "testbed/formats/gltf/selection.h"
#include "testbed/formats/gltf/skin.h"

namespace geoprior {
namespace {

using gltf::Model;

/// How the mesh of a node comes to the rest pose.
struct Placement {
  Eigen::Affine3d to_rest = Eigen::Affine3d::Identity();
  const gltf::SkinBinding* skin = nullptr;
  int joint = -1;  ///< without skin: of all its vertices; -1: the file has no skin
};

/// Corner triples of a primitive, from its mode.
std::vector<std::array<std::uint32_t, 3>> triangles_of(const std::vector<std::uint32_t>& indices,
                                                       int mode, const std::string& where) {
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
  int degenerate = 0;           ///< triangles of lists that name a vertex twice
  std::string without_surface;  ///< the first primitive that is no surface, and where it stands
};

/// "primitive mode 1 (lines)"; empty for triangles.
std::string mode_without_surface(int mode) {
  static constexpr std::array<const char*, 4> kNames{"points", "lines", "line loop", "line strip"};
  if (mode >= 4) return {};
  return "primitive mode " + std::to_string(mode) + " (" + kNames[mode] + ")";
}

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

/// The weights by which morph targets are added without an animation: the node's, else the mesh's.
const std::vector<double>& morph_weights(const Model& model, const gltf::Node& node) {
  return node.weights.empty() ? model.meshes[*node.mesh].weights : node.weights;
}

/// base + sum of weight x displacement (glTF 2.0, 3.7.2.2).
void add_morphs(const Model& model, const gltf::Primitive& primitive, const std::string& where,
                const std::vector<double>& weights, Eigen::MatrixXd& positions) {
  if (weights.empty()) return;
  if (weights.size() != primitive.targets.size()) {
    throw Error(std::to_string(weights.size()) + " default weights for " +
                    std::to_string(primitive.targets.size()) + " morph targets",
                where, "one a target");
  }
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (weights[k] == 0 || !primitive.targets[k]) continue;
    const gltf::Accessor& accessor = model.accessors[*primitive.targets[k]];
    if (accessor.columns != 3 || accessor.is_matrix ||
        accessor.count != static_cast<std::size_t>(positions.rows())) {
      throw Error("POSITION of morph target " + std::to_string(k) + " does not fit the positions",
                  where, "VEC3, one a vertex");
    }
    positions += weights[k] * gltf::decode(model, *primitive.targets[k]);
  }
  if (!positions.allFinite()) throw Error("positions of the morph targets are not finite", where);
}

/// Corners of the triangles that a primitive draws, checked.
std::vector<std::uint32_t> read_corners(const Model& model, const gltf::Primitive& primitive,
                                        const std::string& where, std::size_t count) {
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
  return indices;
}

/// Carries positions to the rest pose: by one transform, or, where the skin is bound in another
/// pose than the skeleton, by those of the joints, blended with the weights from `first_influence`.
Eigen::MatrixXd at_rest(const Eigen::MatrixXd& positions, const Placement& placement,
                        const Builder& builder, std::size_t first_influence) {
  const Eigen::Affine3d& all = placement.to_rest;
  if (placement.skin == nullptr || placement.skin->is_one_pose)
    return (positions * all.linear().transpose()).rowwise() + all.translation().transpose();
  Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(positions.rows(), 3);
  for (std::size_t i = first_influence; i < builder.influences.size(); ++i) {
    const auto& influence = builder.influences[i];
    const Eigen::Index v = influence.row() - builder.vertex_count;
    const Eigen::Vector3d position = positions.row(v).transpose();
    rest.row(v) +=
        influence.value() * (placement.skin->to_rest[influence.col()] * position).transpose();
  }
  return rest;
}

void add_primitive(const Model& model, const gltf::Primitive& primitive, const std::string& where,
                   const std::vector<double>& morphs, const Placement& placement,
                   Builder& builder) {
  Eigen::MatrixXd positions = read_positions(model, primitive, where);
  add_morphs(model, primitive, where, morphs, positions);
  const std::size_t count = positions.rows();
  constexpr std::size_t kMax = std::numeric_limits<int>::max();
  if (count > kMax - builder.vertex_count) throw Error("more than 2^31 vertices", where);
  const std::vector<std::uint32_t> indices = read_corners(model, primitive, where, count);
  const bool mirrored = placement.to_rest.linear().determinant() < 0;
  for (auto t : triangles_of(indices, primitive.mode, where)) {
    if (mirrored) std::swap(t[1], t[2]);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {  // strips restart so
      if (primitive.mode == 4) ++builder.degenerate;
      continue;
    }
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = builder.vertex_count + static_cast<int>(t[k]);
    builder.triangles.push_back(corners);
  }
  const std::size_t first_influence = builder.influences.size();
  if (placement.skin != nullptr) {
    gltf::read_influences(model, primitive, where, *placement.skin, static_cast<int>(count),
                          builder.vertex_count, builder.influences, builder.renormalised);
  } else if (placement.joint >= 0) {
    for (int v = 0; v < static_cast<int>(count); ++v)
      builder.influences.emplace_back(builder.vertex_count + v, placement.joint, 1.0);
  }
  positions = at_rest(positions, placement, builder, first_influence);
  if (!positions.allFinite()) throw Error("positions overflow in the scene", where);
  builder.positions.push_back(std::move(positions));
  builder.vertex_count += static_cast<int>(count);
}

TriMesh finish_mesh(const Builder& builder, const std::string& file) {
  if (builder.triangles.empty() && !builder.without_surface.empty())
    throw Error(builder.without_surface, file, "triangles, triangle strip, triangle fan (4, 5, 6)");
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

void note_attributes(const gltf::Primitive& primitive, const std::vector<double>& morphs,
                     std::vector<std::string>& ignored) {
  const auto add = [&](const std::string& what) {
    if (std::find(ignored.begin(), ignored.end(), what) == ignored.end()) ignored.push_back(what);
  };
  for (const auto& [name, index] : primitive.attributes) {
    if (name != "POSITION" && !name.starts_with("JOINTS_") && !name.starts_with("WEIGHTS_"))
      add("attribute " + name.substr(0, 40));
  }
  const bool moved = std::any_of(morphs.begin(), morphs.end(), [](double w) { return w != 0; });
  if (!primitive.targets.empty() && !moved) add("morph targets, of default weight 0");
}

/// "0.5, 1" of a few weights.
std::string weights_text(const std::vector<double>& weights) {
  constexpr std::size_t kShown = 8;
  std::ostringstream text;
  for (std::size_t k = 0; k < std::min(weights.size(), kShown); ++k)
    text << (k == 0 ? "" : ", ") << weights[k];
  if (weights.size() > kShown) text << " and " << weights.size() - kShown << " more";
  return text.str();
}

void note_morphs(const Model& model, const gltf::Node& node, std::vector<std::string>& notes) {
  const std::vector<double>& weights = morph_weights(model, node);
  if (std::none_of(weights.begin(), weights.end(), [](double w) { return w != 0; })) return;
  notes.push_back("morph targets of " + gltf::mesh_title(model, *node.mesh) +
                  " are added with their default weights " + weights_text(weights));
}

/// Reads the mesh of a node; primitives that are no surface are left out.
void add_node(const Model& model, std::size_t node_index, const Placement& placement,
              Builder& builder, std::vector<std::string>& ignored,
              std::vector<std::string>& notes) {
  const gltf::Node& node = model.nodes[node_index];
  const gltf::Mesh& mesh = model.meshes[*node.mesh];
  const std::vector<double>& morphs = morph_weights(model, node);
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    const gltf::Primitive& primitive = mesh.primitives[p];
    const std::string pointer =
        "/meshes/" + std::to_string(*node.mesh) + "/primitives/" + std::to_string(p);
    const std::string mode = mode_without_surface(primitive.mode);
    if (!mode.empty()) {
      const std::string what = pointer + ": " + mode;
      if (builder.without_surface.empty()) builder.without_surface = what;
      const std::string note = what + " has no surface and is left out";
      if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
      continue;
    }
    note_attributes(primitive, morphs, ignored);
    add_primitive(model, primitive, place(model, pointer), morphs, placement, builder);
  }
  note_morphs(model, node, notes);
}

/// One line for a list of notes of one kind: the first few, and how many more there are.
void warn(const Model& model, const std::vector<std::string>& ignored,
          const std::vector<std::string>& notes, bool renormalised, GltfCharacter& character) {
  constexpr std::size_t kMost = 20;
  const std::string file = model.file.string() + ": ";
  std::string list;
  for (const std::string& what : ignored) list += (list.empty() ? "" : ", ") + what;
  if (!list.empty()) character.warnings.push_back(file + "ignored: " + list);
  for (std::size_t i = 0; i < std::min(notes.size(), kMost); ++i)
    character.warnings.push_back(file + notes[i]);
  if (notes.size() > kMost)
    character.warnings.push_back(file + std::to_string(notes.size() - kMost) + " more notes");
  if (renormalised)
    character.warnings.push_back(file + "weights that did not sum to 1 were scaled");
}

/// Vertices of the mesh of a node in what is read.
struct Block {
  std::size_t node = 0;
  int first = 0;
  int count = 0;
};

/// Notes meshes that are shown again where they were: their surfaces and volumes count twice.
void note_doubles(const Model& model, const TriMesh& mesh, const std::vector<Block>& blocks,
                  std::vector<std::string>& notes) {
  std::map<std::size_t, Block> first_of_mesh;
  const double extent = (mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff()).norm();
  for (const Block& block : blocks) {
    const std::size_t index = *model.nodes[block.node].mesh;
    const auto [known, is_new] = first_of_mesh.emplace(index, block);
    if (is_new || block.count == 0) continue;
    const double apart = (mesh.V.middleRows(block.first, block.count) -
                          mesh.V.middleRows(known->second.first, block.count))
                             .cwiseAbs()
                             .maxCoeff();
    if (apart > 1e-6 * extent) continue;
    const auto title = [&](std::size_t node) {
      const std::string& name = model.nodes[node].name;
      return name.empty() ? std::to_string(node) : "'" + name + "'";
    };
    notes.push_back(gltf::mesh_title(model, index) + ", " + std::to_string(block.count) +
                    " vertices, is shown at the same place by nodes " + title(known->second.node) +
                    " and " + title(block.node) +
                    ": its area and volume count twice (mesh = \"<node>\" reads one)");
  }
}

/// Notes animations of what lies between a mesh without skin and the joint that it is held to.
void note_held(const Model& model, const gltf::Selection& selection, const std::vector<int>& number,
               const std::vector<GltfClip>& clips, std::vector<std::string>& notes) {
  std::vector<bool> is_animated(model.nodes.size(), false);
  for (const GltfClip& clip : clips) {
    for (const GltfTrack& track : clip.tracks) is_animated[track.node] = true;
  }
  for (const gltf::ShownMesh& shown : selection.meshes) {
    if (!shown.joint_node) continue;
    bool moves = false;
    for (std::size_t at = shown.node; at != *shown.joint_node && !moves;
         at = *model.nodes[at].parent)
      moves = is_animated[number[at]];
    if (!moves) continue;
    notes.push_back(gltf::mesh_title(model, *model.nodes[shown.node].mesh) +
                    " has no skin and is held to joint '" + model.nodes[*shown.joint_node].name +
                    "': what the clips move it by besides is left out");
  }
}

/// Where the meshes of the nodes stand in the rest pose, and by what they move.
std::vector<Placement> placements(const Model& model, const gltf::Selection& selection,
                                  const gltf::RigData& rig) {
  const auto world = gltf::world_transforms(model);
  std::map<std::size_t, const gltf::SkinBinding*> skin_of;
  for (std::size_t k = 0; k < selection.skins.size(); ++k)
    skin_of[selection.skins[k]] = &rig.skins[k];
  std::map<std::size_t, int> joint_of;
  for (int j = 0; j < std::ssize(rig.node_of_joint); ++j) joint_of[rig.node_of_joint[j]] = j;
  std::vector<Placement> result;
  for (const gltf::ShownMesh& shown : selection.meshes) {
    if (shown.skin) {
      const gltf::SkinBinding* skin = skin_of.at(*shown.skin);
      result.push_back({skin->first_to_rest, skin, -1});
    } else if (shown.joint_node) {
      const int joint = joint_of.at(*shown.joint_node);
      if (gltf::is_flat(world[*shown.joint_node].linear())) {
        throw Error("joint '" + rig.skeleton.joints[joint].name + "' is scaled to zero",
                    model.file.string() + ": /nodes/" + std::to_string(*shown.joint_node),
                    "scales above zero");
      }
      result.push_back(
          {rig.from_rest[joint].inverse() * world[*shown.joint_node].inverse() * world[shown.node],
           nullptr, joint});
    } else {
      result.push_back({world[shown.node], nullptr, -1});
    }
  }
  return result;
}

void note_skins(const gltf::Selection& selection, const gltf::RigData& rig,
                std::vector<std::string>& notes) {
  for (std::size_t k = 0; k < rig.skins.size(); ++k) {
    if (rig.skins[k].is_one_pose) continue;
    notes.push_back("skin " + std::to_string(selection.skins[k]) +
                    " is bound in another pose than skin " + std::to_string(selection.skins[0]) +
                    ": its meshes are carried there by their weights");
  }
}

GltfCharacter make_character(const Model& model, const GltfReadOptions& options) {
  GltfCharacter character;
  std::vector<std::string> ignored = model.ignored;
  gltf::Selection selection = gltf::select_meshes(model, options.mesh);
  std::vector<std::string>& notes = selection.notes;
  gltf::RigData rig;
  if (!selection.skins.empty()) rig = gltf::read_rig(model, selection.skins);
  note_skins(selection, rig, notes);
  gltf::note_scaled_joints(rig, notes);
  character.first_skin = selection.first_skin;
  character.other_skins = selection.other_skins;
  const std::vector<Placement> where = placements(model, selection, rig);
  Builder builder;
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < where.size(); ++i) {
    const int first = builder.vertex_count;
    add_node(model, selection.meshes[i].node, where[i], builder, ignored, notes);
    blocks.push_back({selection.meshes[i].node, first, builder.vertex_count - first});
    character.part_of_vertex.resize(builder.vertex_count, static_cast<int>(i));
  }
  character.mesh = finish_mesh(builder, model.file.string());
  note_doubles(model, character.mesh, blocks, notes);
  if (builder.degenerate > 0)
    notes.push_back("left out, without area: " + std::to_string(builder.degenerate) +
                    " triangles that name a vertex twice");
  const std::vector<int> number = renumber_nodes(model, character.binding);
  if (!selection.skins.empty()) {
    character.weights.resize(builder.vertex_count, rig.skeleton.size());
    character.weights.setFromTriplets(builder.influences.begin(), builder.influences.end());
    for (const std::size_t node : rig.node_of_joint)
      character.binding.joint_node.push_back(number[node]);
    character.binding.from_rest = rig.from_rest;
    character.skeleton = std::move(rig.skeleton);
    validate(character.weights, builder.vertex_count, character.skeleton->size());
  }
  character.clips = gltf::read_clips(model, number, ignored);
  note_held(model, selection, number, character.clips, notes);
  warn(model, ignored, notes, builder.renormalised, character);
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
