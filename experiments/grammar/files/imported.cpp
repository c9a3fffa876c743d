#include "experiments/grammar/files/imported.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string_view>

#include "core/error.h"
#include "testbed/formats/gltf/container.h"
#include "testbed/formats/gltf/model.h"
#include "testbed/formats/gltf/skin.h"

namespace geoprior::grammar {
namespace {

constexpr std::int64_t kMostImportedVertices = 20'000'000;
constexpr double kMostImportedCoordinate = 1e9;  // m
/// Relative difference of scales below which nodes share a baked mesh.
constexpr double kSameImportedScale = 1e-6;
constexpr double kLeastImportedStretch = 0.05, kMostImportedStretch = 20;

/// A mesh in the frame of a node, with the node's scale and shear.
struct BakedMesh {
  std::size_t source = 0;  ///< of the model
  Eigen::Matrix3d scale;
  TriMesh mesh;            ///< about the element's origin (m)
  Eigen::Vector3d origin;  ///< the element's, in the node's frame (m)
  Eigen::AlignedBox3d box;
};

/// What the elements of a type may show; shared by the functions of the type.
struct ImportedShapes {
  std::vector<BakedMesh> meshes;
  bool has_empty = false;  ///< nodes without mesh: they are the last variant
  [[nodiscard]] int count() const { return static_cast<int>(meshes.size()) + (has_empty ? 1 : 0); }
};

/// (x, y, z) of glTF's world, y up, to (x, -z, y).
Eigen::Matrix3d upright_of_gltf() {
  Eigen::Matrix3d turn;
  turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return turn;
}

/// The rotation nearest to a matrix, also where it mirrors or flattens.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) *= -1;
  return U * svd.matrixV().transpose();
}

/// Refuses also what is not finite.
void require_imported_range(const Eigen::Ref<const Eigen::MatrixXd>& x, const std::string& where) {
  if (!(x.array().abs() <= kMostImportedCoordinate).all())
    throw Error("has positions that are not finite, or far away", where, "up to 1e9 m");
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string type_name_of(std::string name) {
  const auto ends_in_number = [&] { return !name.empty() && is_digit(name.back()); };
  while (ends_in_number()) {
    while (ends_in_number()) name.pop_back();
    while (!name.empty() && std::string_view("._- ").find(name.back()) != std::string_view::npos)
      name.pop_back();
  }
  return name.empty() ? "node" : name;
}

/// The triangles of a primitive as rows of vertices from 0 on: list, strip or fan.
std::vector<std::array<int, 3>> primitive_triangles(const gltf::Model& model,
                                                    const gltf::Primitive& primitive, int vertices,
                                                    const std::string& where) {
  std::vector<std::uint32_t> corners;
  if (primitive.indices) {
    corners = gltf::decode_indices(model, *primitive.indices);
  } else {
    for (int v = 0; v < vertices; ++v) corners.push_back(static_cast<std::uint32_t>(v));
  }
  for (const std::uint32_t c : corners)
    if (c >= static_cast<std::uint32_t>(vertices))
      throw Error("index " + std::to_string(c) + " is out of range", where,
                  "0 to " + std::to_string(vertices - 1));
  const std::size_t step = primitive.mode == 4 ? 3 : 1;
  if (corners.size() % step != 0)
    throw Error(std::to_string(corners.size()) + " corners of triangles", where, "a multiple of 3");
  std::vector<std::array<int, 3>> triangles;
  for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
    const bool turned = primitive.mode == 5 && i % 2 == 1;
    const std::size_t first = primitive.mode == 6 ? 0 : i;
    std::array<int, 3> t{static_cast<int>(corners[first]), static_cast<int>(corners[i + 1]),
                         static_cast<int>(corners[i + 2])};
    if (turned) std::swap(t[1], t[2]);
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return triangles;
}

/// Vertices and triangles of a mesh in its own coordinates.
TriMesh surface_of_gltf(const gltf::Model& model, std::size_t number) {
  const std::string where = gltf::place(model, "/meshes/" + std::to_string(number));
  std::vector<Eigen::MatrixXd> blocks;
  std::vector<std::array<int, 3>> triangles;
  int vertices = 0;
  const auto& primitives = model.meshes[number].primitives;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    if (primitives[p].mode < 4) continue;
    const std::string at = where + "/primitives/" + std::to_string(p);
    const auto position = primitives[p].attributes.find("POSITION");
    if (position == primitives[p].attributes.end()) throw Error("no POSITION", at);
    const gltf::Accessor& accessor = model.accessors[position->second];
    if (accessor.columns != 3 || accessor.is_matrix) throw Error("POSITION is not VEC3", at);
    if (accessor.count > static_cast<std::size_t>(kMostImportedVertices - vertices))
      throw Error("has too many vertices", at, std::to_string(kMostImportedVertices));
    blocks.push_back(gltf::decode(model, position->second));
    if (!blocks.back().allFinite()) throw Error("has positions that are not finite", at);
    const int count = static_cast<int>(blocks.back().rows());
    for (std::array<int, 3> t : primitive_triangles(model, primitives[p], count, at)) {
      for (int& corner : t) corner += vertices;
      triangles.push_back(t);
    }
    vertices += count;
  }
  TriMesh mesh{Eigen::MatrixX3d(vertices, 3), Eigen::MatrixX3i(std::ssize(triangles), 3)};
  int row = 0;
  for (const Eigen::MatrixXd& block : blocks) {
    mesh.V.middleRows(row, block.rows()) = block;
    row += static_cast<int>(block.rows());
  }
  for (int f = 0; f < mesh.triangle_count(); ++f)
    mesh.F.row(f) = Eigen::Map<const Eigen::RowVector3i>(triangles[f].data());
  return mesh;
}

/// Corner k of a box: bottom counter-clockwise from the lowest, then top.
Eigen::Vector3d box_corner(const Eigen::AlignedBox3d& box, int k) {
  const bool right = k % 4 == 1 || k % 4 == 2, back = k % 4 >= 2, top = k >= 4;
  return {(right ? box.max() : box.min()).x(), (back ? box.max() : box.min()).y(),
          (top ? box.max() : box.min()).z()};
}

/// The mesh that an element of these parameters shows; null: none.
const BakedMesh* shown_shape(const ImportedShapes& shapes, std::span<const double> parameters) {
  const int variant = parameters.size() > 3 ? static_cast<int>(std::lround(parameters[3])) : 0;
  return variant < std::ssize(shapes.meshes) ? &shapes.meshes[variant] : nullptr;
}

ElementType imported_type(const std::string& name,
                          const std::shared_ptr<const ImportedShapes>& shapes) {
  ElementType type;
  type.name = name;
  for (const char* parameter : {"stretch_x", "stretch_y", "stretch_z"})
    type.parameters.push_back({parameter, "1", kLeastImportedStretch, kMostImportedStretch});
  if (shapes->count() > 1) type.parameters.push_back({"variant", "1", 0, shapes->count() - 1.});
  if (shapes->meshes.empty()) {
    type.keys = [](std::span<const double>, std::vector<Eigen::Vector3d>& out) {
      out.emplace_back(0, 0, 0);
    };
    return type;
  }
  type.keys = [shapes](std::span<const double> parameters, std::vector<Eigen::Vector3d>& out) {
    const BakedMesh* shape = shown_shape(*shapes, parameters);
    const Eigen::AlignedBox3d box =
        shape != nullptr ? shape->box : Eigen::AlignedBox3d(Eigen::Vector3d(0, 0, 0));
    const Eigen::Vector3d stretch(parameters[0], parameters[1], parameters[2]);
    for (int k = 0; k < 8; ++k) out.push_back(stretch.cwiseProduct(box_corner(box, k)));
  };
  type.mesh = [shapes](std::span<const double> parameters) {
    const BakedMesh* shape = shown_shape(*shapes, parameters);
    if (shape == nullptr) return TriMesh{};
    const Eigen::Vector3d stretch(parameters[0], parameters[1], parameters[2]);
    return TriMesh{shape->mesh.V * stretch.asDiagonal(), shape->mesh.F};
  };
  return type;
}

/// Builds the hierarchy of a model's shown nodes.
class GltfImport {
 public:
  GltfImport(const gltf::Model& model, double unit) : model_(model), unit_(unit) {}
  ImportedScene run();

 private:
  struct Item {
    std::size_t node = 0;
    std::string type, label;
    int parent = -1;
    int variant = -1;  ///< -1: no mesh
    Pose pose;
  };

  void add_items();
  void add_root(int roots);
  void place(Item& item, const Eigen::Affine3d& world);
  int baked_variant(ImportedShapes& shapes, std::size_t mesh, const Eigen::Matrix3d& scale,
                    const std::string& where);
  std::string different_label(const std::string& name);
  [[nodiscard]] std::string name_of(const gltf::Node& node) const;
  [[nodiscard]] std::vector<std::string> warnings() const;
  void add_elements(Hierarchy& hierarchy) const;

  const gltf::Model& model_;
  double unit_;
  std::vector<Item> items_;
  std::map<std::string, std::shared_ptr<ImportedShapes>> shapes_;
  std::vector<std::string> type_order_;
  std::map<std::size_t, TriMesh> surfaces_;  ///< of the model's meshes, as they are met
  std::set<std::string> labels_;
  std::map<std::string, int> label_numbers_;
  std::int64_t vertices_ = 0;
};

/// Control characters would break the lines of tables.
std::string GltfImport::name_of(const gltf::Node& node) const {
  std::string name = node.name;
  if (name.empty() && node.mesh) name = model_.meshes[*node.mesh].name;
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '_';
  return name.empty() ? "node" : name;
}

std::string GltfImport::different_label(const std::string& name) {
  std::string label = name;
  int& number = label_numbers_[name];
  if (number == 0) number = 1;
  while (!labels_.insert(label).second) label = name + "-" + std::to_string(++number);
  return label;
}

int GltfImport::baked_variant(ImportedShapes& shapes, std::size_t mesh,
                              const Eigen::Matrix3d& scale, const std::string& where) {
  for (int i = 0; i < std::ssize(shapes.meshes); ++i) {
    const BakedMesh& known = shapes.meshes[i];
    if (known.source == mesh &&
        (known.scale - scale).norm() <= kSameImportedScale * known.scale.norm())
      return i;
  }
  const auto [surface, is_new] = surfaces_.try_emplace(mesh);
  if (is_new) surface->second = surface_of_gltf(model_, mesh);
  BakedMesh baked{mesh, scale, surface->second, Eigen::Vector3d::Zero(), {}};
  TriMesh& out = baked.mesh;
  const Eigen::Matrix3d to_frame = unit_ * scale * upright_of_gltf();
  out.V = out.V * to_frame.transpose();
  require_imported_range(out.V, where);
  if (scale.determinant() < 0) out.F.col(1).swap(out.F.col(2));
  for (int v = 0; v < out.vertex_count(); ++v) baked.box.extend(out.V.row(v).transpose());
  if (baked.box.isEmpty()) baked.box.extend(Eigen::Vector3d(0, 0, 0));
  if (!baked.box.contains(Eigen::Vector3d(0, 0, 0))) baked.origin = baked.box.center();
  out.V.rowwise() -= baked.origin.transpose();
  baked.box.translate(-baked.origin);
  shapes.meshes.push_back(std::move(baked));
  return static_cast<int>(shapes.meshes.size()) - 1;
}

void GltfImport::place(Item& item, const Eigen::Affine3d& world) {
  const std::string where = gltf::place(model_, "/nodes/" + std::to_string(item.node));
  const Eigen::Matrix3d up = upright_of_gltf();
  const Eigen::Matrix3d linear = up * world.linear() * up.transpose();
  const Eigen::Matrix3d turn = nearest_rotation(linear);
  item.pose = {unit_ * (up * world.translation()), Eigen::Quaterniond(turn).normalized()};
  auto& shapes = shapes_[item.type];
  if (!shapes) {
    shapes = std::make_shared<ImportedShapes>();
    type_order_.push_back(item.type);
  }
  const auto& mesh = model_.nodes[item.node].mesh;
  if (!mesh) {
    shapes->has_empty = true;
  } else {
    item.variant = baked_variant(*shapes, *mesh, turn.transpose() * linear, where);
    const BakedMesh& shape = shapes->meshes[item.variant];
    item.pose.position += turn * shape.origin;
    vertices_ += shape.mesh.vertex_count();
    if (vertices_ > kMostImportedVertices)
      throw Error("the scene is too large", model_.file.string(),
                  std::to_string(kMostImportedVertices) + " vertices over all nodes");
  }
  require_imported_range(item.pose.position, where);
}

void GltfImport::add_root(int roots) {
  if (roots < 2) return;
  Item root;
  root.type = "scene";
  root.label = different_label(root.type);
  for (Item& item : items_) ++item.parent;
  items_.insert(items_.begin(), std::move(root));
  auto& shapes = shapes_["scene"];
  if (!shapes) {
    shapes = std::make_shared<ImportedShapes>();
    type_order_.insert(type_order_.begin(), "scene");
  }
  shapes->has_empty = true;
}

void GltfImport::add_items() {
  const std::vector<Eigen::Affine3d> world = gltf::world_transforms(model_);
  std::vector<int> number(model_.nodes.size(), -1);
  int roots = 0;
  for (const std::size_t i : model_.node_order) {
    const gltf::Node& node = model_.nodes[i];
    if (!node.in_scene) continue;
    Item item;
    item.node = i;
    if (node.parent) item.parent = number[*node.parent];
    roots += item.parent < 0 ? 1 : 0;
    const std::string name = name_of(node);
    item.type = type_name_of(name);
    item.label = different_label(name);
    place(item, world[i]);
    number[i] = static_cast<int>(items_.size());
    items_.push_back(std::move(item));
  }
  if (items_.empty())
    throw Error("shows no nodes", model_.file.string(), "a scene with at least one node");
  add_root(roots);
}

void GltfImport::add_elements(Hierarchy& hierarchy) const {
  std::map<std::string, int> type_number;
  for (const std::string& name : type_order_)
    type_number[name] = hierarchy.add_type(imported_type(name, shapes_.at(name)));
  for (const Item& item : items_) {
    const int type = type_number.at(item.type);
    const ImportedShapes& shapes = *shapes_.at(item.type);
    std::vector<double> parameters(3, 1.);
    if (shapes.count() > 1)
      parameters.push_back(item.variant >= 0 ? item.variant : shapes.count() - 1);
    const int element = hierarchy.add(type, item.parent, item.pose, parameters);
    hierarchy.set_name(element, item.label);
  }
  hierarchy.require_valid();
}

std::vector<std::string> GltfImport::warnings() const {
  std::vector<std::string> left_out = model_.ignored;
  const auto note = [&](std::size_t count, const std::string& what) {
    if (count > 0) left_out.push_back(std::to_string(count) + " " + what);
  };
  note(model_.skins.size(), "skins");
  note(model_.animations.size(), "animations");
  std::size_t morphs = 0, flat = 0;
  for (const gltf::Mesh& mesh : model_.meshes)
    for (const gltf::Primitive& primitive : mesh.primitives) {
      morphs += primitive.targets.size();
      flat += primitive.mode < 4 ? 1 : 0;
    }
  note(morphs, "morph targets");
  note(flat, "primitives of points or lines");
  std::string list;
  for (const std::string& what : left_out) list += (list.empty() ? "" : ", ") + what;
  if (list.empty()) return {};
  return {model_.file.string() + ": left out: " + list};
}

ImportedScene GltfImport::run() {
  if (!(unit_ > 0) || !std::isfinite(unit_))
    throw Error("the unit is " + std::to_string(unit_) + " m", model_.file.string(), "above 0");
  add_items();
  ImportedScene scene;
  add_elements(scene.hierarchy);
  scene.warnings = warnings();
  scene.files.push_back(model_.file);
  for (const gltf::Buffer& buffer : model_.buffers)
    if (buffer.file) scene.files.push_back(*buffer.file);
  return scene;
}

}  // namespace

ImportedScene import_gltf(const std::filesystem::path& file, double unit_m) {
  return GltfImport(gltf::parse_gltf(file), unit_m).run();
}

ImportedScene import_gltf_bytes(const std::vector<std::byte>& bytes,
                                const std::filesystem::path& name, double unit_m) {
  return GltfImport(gltf::parse_gltf(bytes, name, false), unit_m).run();
}

}  // namespace geoprior::grammar
