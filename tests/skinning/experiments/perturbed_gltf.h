// A good glTF file, changed in all that the format leaves free, and what it means: the generator
// writes it from its own arrays and calls no reader of ours.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "tests/support/dice.h"
#include "tests/testbed/formats/gltf_samples.h"

namespace geoprior::skinning {

/// A joint of the generator: its place in the hierarchy, and its transforms.
struct MadeGltfJoint {
  int parent = -1;
  Eigen::Vector3d translation{0, 0, 0};
  Eigen::Quaterniond rotation{1, 0, 0, 0};
  Eigen::Quaterniond posed{1, 0, 0, 0};  ///< its rotation at the end of the clip
};

/// What the file means.
struct GltfMeaning {
  std::vector<Eigen::Vector3d> V;                      ///< rest positions
  std::vector<std::map<std::string, double>> weights;  ///< by joint
  std::set<std::array<int, 3>> triangles;              ///< lowest vertex first
  std::map<std::string, std::string> parents;          ///< of joints
  std::map<std::string, Eigen::Vector3d> heads;
  std::map<std::string, Eigen::Affine3d> end_pose;  ///< at the end of the clip
  std::set<std::string> left_out;                   ///< meshes
};

class PerturbedGltf {
  using json = nlohmann::json;

 public:
  explicit PerturbedGltf(int seed) : dice_(seed, "glTF") {
    make_skeleton();
    add_skin();
    if (dice_.coin()) add_skin();
    const int meshes = 1 + dice_.below(3);
    for (int m = 0; m < meshes; ++m) add_skinned_mesh();
    if (dice_.coin()) add_rigid_mesh();
    if (dice_.coin()) add_mesh_outside();
    if (dice_.coin()) add_other_skeleton();
    add_clip();
    if (dice_.coin()) add_unused();
    finish();
  }

  [[nodiscard]] const GltfMeaning& meaning() const { return meaning_; }

  /// As .glb, or as text with the buffer in a data URI.
  [[nodiscard]] std::vector<std::byte> bytes() {
    if (dice_.coin()) return file_.bytes();
    json document = file_.json;
    document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64();
    const std::string text = document.dump(dice_.coin() ? -1 : 2) + (dice_.coin() ? "\n" : "");
    std::vector<std::byte> bytes(text.size());
    std::memcpy(bytes.data(), text.data(), text.size());
    return bytes;
  }

 private:
  static std::string joint_name(int j) { return "joint " + std::to_string(j); }

  static json numbers(const Eigen::VectorXd& x) {
    json list = json::array();
    for (const double value : x) list.push_back(value);
    return list;
  }

  /// Adds a node whose transform is written as matrix or as its parts.
  int add_node(const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation, double scale,
               int parent, bool as_parts) {
    json node = json::object();
    if (!as_parts && dice_.coin()) {
      const Eigen::Affine3d matrix =
          Eigen::Translation3d(translation) * rotation * Eigen::Scaling(scale);
      node["matrix"] = numbers(Eigen::Map<const Eigen::VectorXd>(matrix.data(), 16));
    } else {
      const double sign = dice_.coin() ? 1 : -1;  // the same rotation
      node["translation"] = numbers(translation);
      node["rotation"] = numbers(sign * rotation.coeffs());
      if (scale != 1 || dice_.coin()) node["scale"] = {scale, scale, scale};
    }
    nodes_.push_back(node);
    parents_.push_back(parent);
    in_scene_.push_back(true);
    return static_cast<int>(nodes_.size()) - 1;
  }

  /// A root node with some scale, and joints below it, some with a plain node between.
  void make_skeleton() {
    root_scale_ = dice_.coin() ? 1 : dice_.uniform(0.5, 2);
    root_translation_ = dice_.vector(1);
    root_rotation_ = dice_.rotation();
    const int root = add_node(root_translation_, root_rotation_, root_scale_, -1, false);
    const int count = 2 + dice_.below(5);
    for (int j = 0; j < count; ++j) {
      MadeGltfJoint joint;
      joint.parent = j == 0 ? -1 : dice_.below(j);
      joint.translation = dice_.vector(1);
      joint.rotation = dice_.rotation();
      joint.posed = dice_.coin() ? dice_.rotation() : joint.rotation;
      int parent = j == 0 ? root : node_of_joint_[joint.parent];
      if (dice_.coin())
        parent = add_node({0, 0, 0}, Eigen::Quaterniond::Identity(), 1, parent, false);
      joints_.push_back(joint);
      node_of_joint_.push_back(add_node(joint.translation, joint.rotation, 1, parent, true));
      nodes_.back()["name"] = joint_name(j);
    }
    for (int j = 0; j < count; ++j) {
      rest_.push_back(world(j, false));
      posed_.push_back(world(j, true));
    }
  }

  [[nodiscard]] Eigen::Affine3d world(int j, bool posed) const {
    const Eigen::Affine3d root =
        Eigen::Translation3d(root_translation_) * root_rotation_ * Eigen::Scaling(root_scale_);
    const Eigen::Affine3d local = Eigen::Translation3d(joints_[j].translation) *
                                  (posed ? joints_[j].posed : joints_[j].rotation);
    return (joints_[j].parent < 0 ? root : world(joints_[j].parent, posed)) * local;
  }

  /// A skin of all joints or, of a second one, of some; its meshes have coordinates of their own.
  void add_skin() {
    std::vector<int> list(joints_.size());
    std::iota(list.begin(), list.end(), 0);
    if (!skin_joints_.empty() && dice_.coin())
      list.resize(1 + dice_.below(static_cast<int>(list.size())));
    dice_.shuffle(list);
    const Eigen::Affine3d to_rest = Eigen::Translation3d(dice_.vector(2)) * dice_.rotation() *
                                    Eigen::Scaling(dice_.uniform(0.5, 2));
    std::vector<float> matrices;
    for (const int j : list) {
      const Eigen::Affine3d inverse = rest_[j].inverse() * to_rest;
      for (int i = 0; i < 16; ++i)
        matrices.push_back(static_cast<float>(i % 4 == 3 ? (i == 15 ? 1 : 0) : inverse.data()[i]));
    }
    json joints = json::array();
    for (const int j : list) joints.push_back(node_of_joint_[j]);
    skins_.push_back(
        {{"joints", joints}, {"inverseBindMatrices", place_floats(matrices, 16, "MAT4")}});
    skin_joints_.push_back(list);
    skin_to_rest_.push_back(to_rest);
  }

  /// Values as an accessor: alone, interleaved with padding, behind an offset, or with some of them
  /// sparse.
  template <class T>
  std::size_t place_values(std::vector<T> values, int columns, const char* type, int component,
                           bool normalized, bool may_be_sparse) {
    const std::size_t count = values.size() / columns;
    std::vector<std::size_t> sparse;
    const std::vector<T> right = values;
    if (may_be_sparse && dice_.below(3) == 0) {
      for (std::size_t i = 0; i < count; ++i)
        if (dice_.coin()) sparse.push_back(i);
      for (const std::size_t i : sparse)
        for (int c = 0; c < columns; ++c) values[i * columns + c] = 0;
    }
    const std::size_t element = columns * sizeof(T);
    std::size_t stride = (element + 3) / 4 * 4;
    const bool strided = stride != element || dice_.coin();
    if (dice_.coin() && strided) stride += 4 * dice_.below(5);
    if (!strided) stride = element;
    const std::size_t offset = 4 * dice_.below(3);
    std::vector<std::uint8_t> data(offset + stride * (count - 1) + element, 0xAB);
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(data.data() + offset + i * stride, values.data() + i * columns, element);
    json accessor{{"componentType", component}, {"count", count}, {"type", type}};
    if (normalized) accessor["normalized"] = true;
    accessor["bufferView"] = add_view(data);
    if (offset > 0) accessor["byteOffset"] = offset;
    if (strided && component != 5125) file_.json["bufferViews"].back()["byteStride"] = stride;
    if (!sparse.empty()) accessor["sparse"] = sparse_of(right, columns, sparse);
    file_.json["accessors"].push_back(accessor);
    return file_.json["accessors"].size() - 1;
  }

  template <class T>
  json sparse_of(const std::vector<T>& right, int columns, const std::vector<std::size_t>& which) {
    std::vector<T> values;
    for (const std::size_t i : which)
      values.insert(values.end(), right.begin() + i * columns, right.begin() + (i + 1) * columns);
    std::vector<std::uint8_t> data(values.size() * sizeof(T));
    std::memcpy(data.data(), values.data(), data.size());
    std::vector<std::uint16_t> indices(which.begin(), which.end());
    std::vector<std::uint8_t> index_data(2 * indices.size());
    std::memcpy(index_data.data(), indices.data(), index_data.size());
    const auto index_view = add_view(index_data);
    const auto value_view = add_view(data);
    return {{"count", which.size()},
            {"indices", {{"bufferView", index_view}, {"componentType", 5123}}},
            {"values", {{"bufferView", value_view}}}};
  }

  std::size_t add_view(const std::vector<std::uint8_t>& data) {
    for (int k = 4 * dice_.below(3); k > 0; --k) file_.binary.push_back(std::byte{0xCD});
    return file_.view(data);
  }

  std::size_t place_floats(const std::vector<float>& values, int columns, const char* type) {
    return place_values(values, columns, type, 5126, false, columns == 3);
  }

  struct Shape {
    json primitive;
    std::vector<Eigen::Vector3d> V;  ///< in the coordinates of the mesh, with morph targets
    int first = 0;                   ///< of its vertices in the meaning
  };

  /// A primitive of random triangles; positions as floats or as normalised integers, indices of any
  /// type or none, triangles as a list, a strip or a fan.
  Shape add_shape(const std::vector<double>& morphs) {
    Shape shape;
    shape.first = static_cast<int>(meaning_.V.size());
    const int mode = 4 + dice_.below(3);
    const bool indexed = dice_.coin();
    const int count = 3 * (2 + dice_.below(5));
    std::vector<int> corners(indexed && mode == 4 ? 3 * (1 + dice_.below(8)) : count);
    std::iota(corners.begin(), corners.end(), 0);
    if (indexed && mode == 4) {
      for (std::size_t i = 0; i < corners.size(); i += 3) {
        std::vector<int> some(count);
        std::iota(some.begin(), some.end(), 0);
        dice_.shuffle(some);
        std::copy_n(some.begin(), 3, corners.begin() + static_cast<std::ptrdiff_t>(i));
      }
    } else if (indexed) {
      dice_.shuffle(corners);
    }
    note_triangles(corners, mode, shape.first);
    if (mode != 4 || dice_.coin()) shape.primitive["mode"] = mode;
    if (indexed) shape.primitive["indices"] = place_indices(corners);
    place_positions(count, morphs, shape);
    return shape;
  }

  void note_triangles(const std::vector<int>& corners, int mode, int first) {
    const std::size_t step = mode == 4 ? 3 : 1;
    for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
      std::array<int, 3> t{corners[i], corners[i + 1], corners[i + 2]};
      if (mode == 5 && i % 2 == 1) std::swap(t[1], t[2]);
      if (mode == 6) t = {corners[0], corners[i + 1], corners[i + 2]};
      for (int& corner : t) corner += first;
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      triangles_.push_back(t);
    }
  }

  std::size_t place_indices(const std::vector<int>& corners) {
    switch (dice_.below(3)) {
      case 0:
        file_.json["accessors"].push_back(
            {{"bufferView", add_view({corners.begin(), corners.end()})},
             {"componentType", 5121},
             {"count", corners.size()},
             {"type", "SCALAR"}});
        return file_.json["accessors"].size() - 1;
      case 1:
        return file_.accessor<std::uint16_t>({corners.begin(), corners.end()}, "SCALAR", 1, 5123);
      default:
        return file_.accessor<std::uint32_t>({corners.begin(), corners.end()}, "SCALAR", 1, 5125);
    }
  }

  void place_positions(int count, const std::vector<double>& morphs, Shape& shape) {
    std::vector<float> base;
    std::vector<std::int16_t> quantised;
    const bool floats = dice_.below(3) > 0;
    for (int i = 0; i < 3 * count; ++i) {
      const double x = dice_.uniform(-1, 1);
      base.push_back(static_cast<float>(x));
      quantised.push_back(static_cast<std::int16_t>(x * 32767));
    }
    for (int v = 0; v < count; ++v) {
      shape.V.emplace_back();
      for (int k = 0; k < 3; ++k)
        shape.V.back()[k] = floats ? base[3 * v + k] : quantised[3 * v + k] / 32767.0;
    }
    shape.primitive["attributes"]["POSITION"] =
        floats ? place_floats(base, 3, "VEC3")
               : place_values(quantised, 3, "VEC3", 5122, true, true);
    if (!floats) uses_quantization_ = true;
    for (const double weight : morphs) {
      std::vector<float> target;
      for (int i = 0; i < 3 * count; ++i)
        target.push_back(static_cast<float>(dice_.uniform(-1, 1)));
      for (int v = 0; v < count; ++v)
        for (int k = 0; k < 3; ++k) shape.V[v][k] += weight * target[3 * v + k];
      shape.primitive["targets"].push_back({{"POSITION", place_floats(target, 3, "VEC3")}});
    }
  }

  /// Weights of some joints of a skin, as floats or normalised integers.
  void weigh(const std::vector<int>& joints, Shape& shape) {
    const int kind = dice_.below(3);
    std::vector<double> weights;
    std::vector<std::uint16_t> entries;
    for (std::size_t v = 0; v < shape.V.size(); ++v) {
      std::vector<int> order(joints.size());
      std::iota(order.begin(), order.end(), 0);
      dice_.shuffle(order);
      const int used = 1 + dice_.below(std::min(4, static_cast<int>(joints.size())));
      std::array<double, 4> w{};
      for (int k = 0; k < used; ++k) w[k] = 0.1 + dice_.uniform(0, 1);
      const double sum = w[0] + w[1] + w[2] + w[3];
      double stored_sum = 0;
      for (double& x : w) {
        x /= sum;
        if (kind == 1) x = std::round(255 * x) / 255;
        if (kind == 2) x = std::round(65535 * x) / 65535;
        stored_sum += x;
      }
      std::map<std::string, double> of_vertex;
      for (int k = 0; k < 4; ++k) {
        const int entry = k < used ? order[k] : dice_.below(static_cast<int>(joints.size()));
        entries.push_back(static_cast<std::uint16_t>(entry));
        weights.push_back(w[k]);
        if (w[k] > 0) of_vertex[joint_name(joints[entry])] += w[k] / stored_sum;
      }
      meaning_.weights.push_back(of_vertex);
    }
    auto& attributes = shape.primitive["attributes"];
    attributes["JOINTS_0"] =
        dice_.coin() ? place_values(entries, 4, "VEC4", 5123, false, false)
                     : place_values(std::vector<std::uint8_t>(entries.begin(), entries.end()), 4,
                                    "VEC4", 5121, false, false);
    attributes["WEIGHTS_0"] = place_weights(weights, kind);
  }

  std::size_t place_weights(const std::vector<double>& weights, int kind) {
    if (kind == 0) {
      return place_floats({weights.begin(), weights.end()}, 4, "VEC4");
    }
    if (kind == 1) {
      std::vector<std::uint8_t> bytes;
      for (const double w : weights)
        bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * w)));
      return place_values(bytes, 4, "VEC4", 5121, true, false);
    }
    std::vector<std::uint16_t> words;
    for (const double w : weights)
      words.push_back(static_cast<std::uint16_t>(std::lround(65535 * w)));
    return place_values(words, 4, "VEC4", 5123, true, false);
  }

  void note_vertices(const Shape& shape, const Eigen::Affine3d& to_rest) {
    for (const Eigen::Vector3d& v : shape.V) meaning_.V.push_back(to_rest * v);
  }

  std::vector<double> morph_weights() {
    std::vector<double> weights(dice_.below(3));
    for (double& w : weights) w = dice_.coin() ? 0 : dice_.uniform(-1, 1);
    return weights;
  }

  int add_mesh(const json& primitives, const std::string& name) {
    meshes_.push_back({{"name", name}, {"primitives", primitives}});
    return static_cast<int>(meshes_.size()) - 1;
  }

  void add_skinned_mesh() {
    const std::size_t skin = dice_.below(static_cast<int>(skins_.size()));
    const std::vector<double> morphs = morph_weights();
    json primitives = json::array();
    const int count = 1 + dice_.below(2);
    for (int p = 0; p < count; ++p) {
      Shape shape = add_shape(morphs);
      weigh(skin_joints_[skin], shape);
      note_vertices(shape, skin_to_rest_[skin]);
      primitives.push_back(shape.primitive);
      if (dice_.below(4) > 0) continue;
      primitives.push_back(shape.primitive);  // its edges, which are no surface
      primitives.back()["mode"] = dice_.below(4);
    }
    const int mesh = add_mesh(primitives, "skin " + std::to_string(meshes_.size()));
    // The node of a skinned mesh may stand anywhere, also below a joint: its transform is no
    // matter.
    const int parent =
        dice_.coin() ? -1 : node_of_joint_[dice_.below(static_cast<int>(joints_.size()))];
    const int node = add_node(dice_.vector(3), dice_.rotation(), 3, parent, false);
    nodes_[node]["mesh"] = mesh;
    nodes_[node]["skin"] = skin;
    used_skins_.insert(skin);
    if (!morphs.empty()) (dice_.coin() ? nodes_[node] : meshes_[mesh])["weights"] = morphs;
  }

  /// A mesh that hangs on a joint, with a node of its own or on the joint's.
  void add_rigid_mesh() {
    const int joint = dice_.below(static_cast<int>(joints_.size()));
    if (!is_in_a_used_skin(joint)) return;
    const std::vector<double> morphs = morph_weights();
    Shape shape = add_shape(morphs);
    const int mesh = add_mesh(json::array({shape.primitive}), "eye");
    if (!morphs.empty()) meshes_[mesh]["weights"] = morphs;
    const Eigen::Vector3d t = dice_.vector(1);
    const Eigen::Quaterniond r = dice_.rotation();
    const double scale = dice_.uniform(0.5, 2);
    const int node = add_node(t, r, scale, node_of_joint_[joint], false);
    nodes_[node]["mesh"] = mesh;
    note_vertices(shape, rest_[joint] * (Eigen::Translation3d(t) * r * Eigen::Scaling(scale)));
    for (std::size_t v = 0; v < shape.V.size(); ++v)
      meaning_.weights.push_back({{joint_name(joint), 1.0}});
  }

  [[nodiscard]] bool is_in_a_used_skin(int joint) const {
    return std::any_of(used_skins_.begin(), used_skins_.end(), [&](std::size_t skin) {
      const auto& list = skin_joints_[skin];
      return std::find(list.begin(), list.end(), joint) != list.end();
    });
  }

  /// A mesh that the scene does not show: nothing of it may be in the meaning.
  void add_mesh_outside() {
    const GltfMeaning before = meaning_;
    const auto triangles = triangles_;
    Shape shape = add_shape({});
    weigh(skin_joints_[0], shape);
    meaning_ = before;
    triangles_ = triangles;
    const int node = add_node({0, 0, 0}, Eigen::Quaterniond::Identity(), 1, -1, false);
    nodes_[node]["mesh"] = add_mesh(json::array({shape.primitive}), "lod");
    nodes_[node]["skin"] = 0;
    in_scene_[node] = false;
    meaning_.left_out.insert("lod");
  }

  /// A second character, whose joints have nothing to do with those of the first.
  void add_other_skeleton() {
    const GltfMeaning before = meaning_;
    const auto triangles = triangles_;
    Shape shape = add_shape({});
    weigh({0, 1}, shape);
    meaning_ = before;
    triangles_ = triangles;
    const int first = add_node(dice_.vector(1), dice_.rotation(), 1, -1, false);
    const int second = add_node(dice_.vector(1), dice_.rotation(), 1, first, false);
    // Deeper than all of the first, so that this is not the skeleton that comes first.
    int parent = second;
    for (int depth = 0; depth < 20; ++depth)
      parent = add_node({0, 0, 0}, Eigen::Quaterniond::Identity(), 1, parent, false);
    nodes_[parent]["mesh"] = add_mesh(json::array({shape.primitive}), "dog");
    nodes_[parent]["skin"] = skins_.size();
    skins_.push_back({{"joints", {first, second}}});
    meaning_.left_out.insert("dog");
  }

  /// From the rest pose to the other in one second; keys of some joints are given in the middle
  /// too.
  void add_clip() {
    json samplers = json::array(), channels = json::array();
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const Eigen::Vector4d from = joints_[j].rotation.coeffs();
      const Eigen::Vector4d to = joints_[j].posed.coeffs();
      std::vector<float> times{0, 1}, keys;
      for (const Eigen::Vector4d& q : {from, to})
        for (const double x : q) keys.push_back(static_cast<float>(x));
      const auto input = file_.accessor<float>(times, "SCALAR", 1, 5126);
      const auto output = place_floats(keys, 4, "VEC4");
      channels.push_back({{"sampler", samplers.size()},
                          {"target", {{"node", node_of_joint_[j]}, {"path", "rotation"}}}});
      samplers.push_back({{"input", input}, {"output", output}});
      if (dice_.coin()) samplers.back()["interpolation"] = dice_.coin() ? "LINEAR" : "STEP";
    }
    file_.json["animations"] = json::array({{{"samplers", samplers}, {"channels", channels}}});
  }

  /// Views, accessors, buffers and nodes that nothing refers to.
  void add_unused() {
    file_.accessor<float>({1, 2, 3}, "VEC3", 3, 5126);
    add_node({9, 9, 9}, Eigen::Quaterniond::Identity(), 1, -1, false);
    in_scene_.back() = dice_.coin();
    has_second_buffer_ = true;
    file_.json["cameras"] = json::array({{{"type", "perspective"}}});
    file_.json["extensionsUsed"] = {"EXT_unheard_of"};
  }

  /// Writes nodes in another order, and the scenes.
  void finish() {
    std::vector<int> order(nodes_.size());
    std::iota(order.begin(), order.end(), 0);
    dice_.shuffle(order);
    std::vector<int> number(nodes_.size());
    for (std::size_t k = 0; k < order.size(); ++k) number[order[k]] = static_cast<int>(k);
    for (const int n : order) file_.json["nodes"].push_back(nodes_[n]);
    std::vector<int> roots, other;
    for (const int n : order) {
      if (parents_[n] >= 0)
        file_.json["nodes"][number[parents_[n]]]["children"].push_back(number[n]);
      if (parents_[n] < 0) (in_scene_[n] ? roots : other).push_back(number[n]);
    }
    for (json& skin : skins_)
      for (json& joint : skin["joints"]) joint = number[joint.get<int>()];
    for (json& channel : file_.json["animations"][0]["channels"]) {
      json& node = channel["target"]["node"];
      node = number[node.get<int>()];
    }
    dice_.shuffle(roots);
    file_.json["scenes"] = json::array({{{"nodes", roots}}});
    if (dice_.coin()) {
      json second = json::object();
      if (!other.empty()) second["nodes"] = other;
      const bool before = dice_.coin();
      file_.json["scenes"].insert(
          before ? file_.json["scenes"].begin() : file_.json["scenes"].end(), second);
      if (before) file_.json["scene"] = 1;
    }
    file_.json["skins"] = skins_;
    file_.json["meshes"] = meshes_;
    if (uses_quantization_) {
      file_.json["extensionsUsed"].push_back("KHR_mesh_quantization");
      file_.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    }
    file_.json["buffers"] = json::array({{{"byteLength", file_.binary.size()}}});
    if (has_second_buffer_) {
      file_.json["buffers"].push_back(
          {{"byteLength", 3}, {"uri", "data:application/gltf-buffer;base64,AAAA"}});
    }
    note_joints();
    meaning_.triangles.insert(triangles_.begin(), triangles_.end());
  }

  /// Joints of the skins that are used; the parent of one is the nearest of them above it.
  void note_joints() {
    for (int j = 0; j < static_cast<int>(joints_.size()); ++j) {
      if (!is_in_a_used_skin(j)) continue;
      int parent = joints_[j].parent;
      while (parent >= 0 && !is_in_a_used_skin(parent)) parent = joints_[parent].parent;
      meaning_.parents[joint_name(j)] = parent < 0 ? std::string() : joint_name(parent);
      meaning_.heads[joint_name(j)] = rest_[j].translation();
      meaning_.end_pose[joint_name(j)] = posed_[j] * rest_[j].inverse();
    }
  }

  [[nodiscard]] std::string base64() const {
    static constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < file_.binary.size(); i += 3) {
      std::uint32_t word = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const bool has = i + k < file_.binary.size();
        word = word << 8U | (has ? std::to_integer<std::uint32_t>(file_.binary[i + k]) : 0U);
      }
      for (std::size_t k = 0; k < 4; ++k) {
        const bool has = i + k < file_.binary.size() + 1;
        text += has ? kDigits[word >> (18 - 6 * k) & 63U] : '=';
      }
    }
    return text;
  }

  test::Dice dice_;
  test::GltfSample file_;
  GltfMeaning meaning_;
  std::vector<std::array<int, 3>> triangles_;
  double root_scale_ = 1;
  Eigen::Vector3d root_translation_{0, 0, 0};
  Eigen::Quaterniond root_rotation_{1, 0, 0, 0};
  std::vector<MadeGltfJoint> joints_;
  std::vector<int> node_of_joint_;
  std::vector<Eigen::Affine3d> rest_, posed_;
  std::vector<json> nodes_;
  std::vector<int> parents_;
  std::vector<bool> in_scene_;
  std::vector<json> skins_, meshes_;
  std::vector<std::vector<int>> skin_joints_;
  std::vector<Eigen::Affine3d> skin_to_rest_;
  std::set<std::size_t> used_skins_;
  bool uses_quantization_ = false;
  bool has_second_buffer_ = false;
};

}  // namespace geoprior::skinning
