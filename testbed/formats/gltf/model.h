#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace geoprior::gltf {

/// The part of a glTF 2.0 file that a rigged character is made of, as plain structs.
///
/// `parse_gltf` has checked every type, every index and the node hierarchy, so readers of the model
/// may follow an index without a look. The bytes of accessors are checked when they are decoded.
/// Source: Khronos glTF 2.0 specification, https://registry.khronos.org/glTF/specs/2.0.

enum class Component { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

struct BufferView {
  std::size_t buffer = 0;
  std::size_t offset = 0;
  std::size_t length = 0;
  std::optional<std::size_t> stride;
};

struct SparseValues {
  std::size_t count = 0;
  std::size_t index_view = 0;
  std::size_t index_offset = 0;
  Component index_type = Component::u32;
  std::size_t value_view = 0;
  std::size_t value_offset = 0;
};

struct Accessor {
  std::optional<std::size_t> view;  ///< absent: zeros, with `sparse` on top
  std::size_t offset = 0;
  Component component = Component::f32;
  bool normalized = false;
  std::size_t count = 0;
  int columns = 1;  ///< 1 … 4, 9 or 16
  bool is_matrix = false;
  std::optional<SparseValues> sparse;
};

struct Primitive {
  int mode = 4;
  std::optional<std::size_t> indices;
  std::map<std::string, std::size_t> attributes;
  /// Accessor of the displacements of each morph target; absent: it moves no position.
  std::vector<std::optional<std::size_t>> targets;
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<double> weights;  ///< of the morph targets, by default; empty: all zero
};

struct Node {
  std::string name;
  std::optional<std::size_t> parent;
  std::vector<std::size_t> children;
  std::optional<std::size_t> mesh;
  std::optional<std::size_t> skin;
  bool is_hidden = false;                 ///< with its children (KHR_node_visibility)
  bool in_scene = true;                   ///< reached from the scene that is shown, and not hidden
  std::vector<double> weights;            ///< of the mesh's morph targets; empty: those of the mesh
  std::optional<Eigen::Affine3d> matrix;  ///< given as matrix: the three below are unused
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

struct Skin {
  std::string name;
  std::vector<std::size_t> joints;  ///< nodes
  std::optional<std::size_t> inverse_bind_matrices;
};

struct Sampler {
  std::size_t input = 0;
  std::size_t output = 0;
  std::string interpolation = "LINEAR";
};

struct Channel {
  std::size_t sampler = 0;
  std::optional<std::size_t> node;
  std::string path;
};

struct Animation {
  std::string name;
  std::vector<Sampler> samplers;
  std::vector<Channel> channels;
};

struct Buffer {
  std::optional<std::filesystem::path> file;  ///< absent: a data URI or the binary chunk
  std::size_t length = 0;
  std::vector<std::byte> bytes;
};

struct Model {
  std::filesystem::path file;
  std::vector<Buffer> buffers;
  std::vector<BufferView> views;
  std::vector<Accessor> accessors;
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;
  std::vector<std::size_t> node_order;  ///< parents before children
  std::string scene;                    ///< "scene 0 'street'", whose nodes are shown; empty: all
  std::vector<Skin> skins;
  std::vector<Animation> animations;
  std::vector<std::string> ignored;  ///< "2 materials", "1 camera", "extension X" …
};

/// Parses a .glb or .gltf and the buffers it refers to, which are files beside it or data URIs.
/// @throws Error  naming the file and the JSON pointer ("/nodes/3/mesh") of what is wrong
Model parse_gltf(const std::filesystem::path& file);

/// Parses the bytes of such a file; buffers in other files are refused when `folder` is absent
/// (fuzzing).
Model parse_gltf(const std::vector<std::byte>& bytes, const std::filesystem::path& file,
                 bool other_files_allowed);

/// Values of an accessor, one row an element (matrices column by column); normalised integers are
/// mapped to [-1, 1] or [0, 1]. Sparse and strided accessors are resolved.
/// @throws Error  when it reaches out of its buffer or, without a buffer view, has over 2^20
/// elements
Eigen::MatrixXd decode(const Model& model, std::size_t accessor);

/// Values of an accessor of unsigned integers of one column.
std::vector<std::uint32_t> decode_indices(const Model& model, std::size_t accessor);

/// "file: /accessors/3", for messages.
std::string place(const Model& model, const std::string& pointer);

}  // namespace geoprior::gltf
