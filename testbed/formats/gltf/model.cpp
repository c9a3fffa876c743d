#include "testbed/formats/gltf/model.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "testbed/formats/gltf/container.h"
#include "testbed/formats/gltf/extensions.h"
#include "testbed/formats/text/nesting.h"

namespace geoprior::gltf {
namespace {

std::size_t bytes_of(Component component) {
  switch (component) {
    case Component::i8:
    case Component::u8:
      return 1;
    case Component::i16:
    case Component::u16:
      return 2;
    case Component::u32:
    case Component::f32:
      return 4;
  }
  return 4;
}

template <class T>
T load(const std::byte* at) {
  T x;
  std::memcpy(&x, at, sizeof(T));
  return x;
}

double load_component(const std::byte* at, Component component, bool normalized) {
  switch (component) {
    case Component::i8: {
      const double x = load<std::int8_t>(at);
      return normalized ? std::max(x / 127.0, -1.0) : x;
    }
    case Component::u8:
      return load<std::uint8_t>(at) / (normalized ? 255.0 : 1.0);
    case Component::i16: {
      const double x = load<std::int16_t>(at);
      return normalized ? std::max(x / 32767.0, -1.0) : x;
    }
    case Component::u16:
      return load<std::uint16_t>(at) / (normalized ? 65535.0 : 1.0);
    case Component::u32:
      return load<std::uint32_t>(at);
    case Component::f32:
      return load<float>(at);
  }
  return 0;
}

/// Columns of matrices of one- and two-byte components start at multiples of four bytes.
std::vector<std::size_t> component_offsets(const Accessor& accessor) {
  const std::size_t size = bytes_of(accessor.component);
  const std::size_t columns = accessor.columns;
  const std::size_t rows = !accessor.is_matrix ? columns : columns == 4 ? 2 : columns == 9 ? 3 : 4;
  const std::size_t column_bytes = accessor.is_matrix ? (rows * size + 3) / 4 * 4 : rows * size;
  std::vector<std::size_t> offsets;
  for (std::size_t i = 0; i < columns; ++i)
    offsets.push_back(i / rows * column_bytes + i % rows * size);
  return offsets;
}

/// Start of `count` elements of `element` bytes, `stride` apart, after a check that they lie in the
/// view.
const std::byte* range(const Model& model, std::size_t view_index, std::size_t offset,
                       std::size_t count, std::size_t stride, std::size_t element,
                       const std::string& where) {
  const BufferView& view = model.views[view_index];
  const bool fits = offset <= view.length && element <= view.length - offset &&
                    count - 1 <= (view.length - offset - element) / stride;
  if (!fits) {
    throw Error(std::to_string(count) + " elements of " + std::to_string(element) +
                    " bytes from byte " + std::to_string(offset) + " reach out of buffer view " +
                    std::to_string(view_index),
                where, "at most its " + std::to_string(view.length) + " bytes");
  }
  return model.buffers[view.buffer].bytes.data() + view.offset + offset;
}

void apply_sparse(const Model& model, const Accessor& accessor, const std::string& where,
                  const std::vector<std::size_t>& offsets, std::size_t element,
                  Eigen::MatrixXd& values) {
  const SparseValues& sparse = *accessor.sparse;
  const std::size_t index_bytes = bytes_of(sparse.index_type);
  const std::byte* indices = range(model, sparse.index_view, sparse.index_offset, sparse.count,
                                   index_bytes, index_bytes, where + "/sparse/indices");
  const std::byte* data = range(model, sparse.value_view, sparse.value_offset, sparse.count,
                                element, element, where + "/sparse/values");
  for (std::size_t k = 0; k < sparse.count; ++k) {
    const double index = load_component(indices + k * index_bytes, sparse.index_type, false);
    if (index >= static_cast<double>(accessor.count)) {
      throw Error(
          "sparse index " + std::to_string(static_cast<std::uint64_t>(index)) + " is out of range",
          where, "0 to " + std::to_string(accessor.count - 1));
    }
    for (std::size_t c = 0; c < offsets.size(); ++c) {
      values(static_cast<Eigen::Index>(index), static_cast<Eigen::Index>(c)) =
          load_component(data + k * element + offsets[c], accessor.component, accessor.normalized);
    }
  }
}

}  // namespace

Eigen::MatrixXd decode(const Model& model, std::size_t accessor_index) {
  // An accessor without data costs its file nothing: bounded, so that a few bytes cannot ask for
  // all memory.
  constexpr std::size_t kMaxWithoutData = std::size_t{1} << 20;
  const Accessor& accessor = model.accessors[accessor_index];
  const std::string where = place(model, "/accessors/" + std::to_string(accessor_index));
  const std::vector<std::size_t> offsets = component_offsets(accessor);
  const std::size_t element = offsets.back() + bytes_of(accessor.component);
  const std::byte* data = nullptr;
  std::size_t stride = element;
  if (accessor.view) {
    stride = model.views[*accessor.view].stride.value_or(element);
    if (stride < element) {
      throw Error("elements of " + std::to_string(element) + " bytes overlap at a stride of " +
                      std::to_string(stride),
                  where);
    }
    data = range(model, *accessor.view, accessor.offset, accessor.count, stride, element, where);
  } else if (accessor.count > kMaxWithoutData) {
    throw Error(std::to_string(accessor.count) + " elements without a buffer view", where,
                "at most " + std::to_string(kMaxWithoutData));
  }
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(accessor.count, accessor.columns);
  if (data != nullptr) {
    for (std::size_t i = 0; i < accessor.count; ++i) {
      for (std::size_t c = 0; c < offsets.size(); ++c) {
        values(i, c) =
            load_component(data + i * stride + offsets[c], accessor.component, accessor.normalized);
      }
    }
  }
  if (accessor.sparse) apply_sparse(model, accessor, where, offsets, element, values);
  return values;
}

std::vector<std::uint32_t> decode_indices(const Model& model, std::size_t accessor_index) {
  const Accessor& accessor = model.accessors[accessor_index];
  const bool is_unsigned = accessor.component == Component::u8 ||
                           accessor.component == Component::u16 ||
                           accessor.component == Component::u32;
  if (!is_unsigned || accessor.columns != 1 || accessor.normalized) {
    throw Error("indices are not unsigned integers",
                place(model, "/accessors/" + std::to_string(accessor_index)),
                "SCALAR of component type 5121, 5123, 5125");
  }
  const Eigen::MatrixXd values = decode(model, accessor_index);
  std::vector<std::uint32_t> indices(values.rows());
  for (std::size_t i = 0; i < indices.size(); ++i)
    indices[i] = static_cast<std::uint32_t>(values(i, 0));
  return indices;
}

namespace {

using nlohmann::json;

/// A JSON value and where it stands, for messages.
class At {
 public:
  At(const json& value, std::string pointer, const std::filesystem::path& file)
      : value_(value), pointer_(std::move(pointer)), file_(file) {}

  [[noreturn]] void fail(const std::string& problem, const std::string& allowed = {}) const {
    throw Error(problem, file_.string() + ": " + (pointer_.empty() ? "/" : pointer_), allowed);
  }

  [[nodiscard]] const json& value() const { return value_; }
  [[nodiscard]] bool has(const char* key) const { return value_.contains(key); }

  [[nodiscard]] At member(const char* key) const {
    const auto it = value_.find(key);
    if (it == value_.end()) fail(std::string("'") + key + "' is missing");
    return {*it, pointer_ + "/" + key, file_};
  }
  [[nodiscard]] const At& object() const {
    if (!value_.is_object()) fail(std::string("is of type ") + value_.type_name(), "object");
    return *this;
  }
  [[nodiscard]] std::vector<At> elements() const {
    if (!value_.is_array()) fail(std::string("is of type ") + value_.type_name(), "array");
    std::vector<At> result;
    for (std::size_t i = 0; i < value_.size(); ++i)
      result.emplace_back(value_[i], pointer_ + "/" + std::to_string(i), file_);
    return result;
  }
  /// Elements of an array that may be absent.
  [[nodiscard]] std::vector<At> elements(const char* key) const {
    return has(key) ? member(key).elements() : std::vector<At>{};
  }
  [[nodiscard]] std::size_t size() const {
    // 2^40 bytes are beyond any file we could hold; the bound keeps sums of sizes from overflowing.
    constexpr std::uint64_t kLimit = std::uint64_t{1} << 40;
    if (!value_.is_number_unsigned() || value_.get<std::uint64_t>() > kLimit) {
      // Only numbers are printed: a dump of others recurses as deeply as the file nests.
      fail("is " + (value_.is_number() ? value_.dump() : std::string(value_.type_name())),
           "an integer, 0 to 2^40");
    }
    return value_.get<std::size_t>();
  }
  [[nodiscard]] std::size_t size(const char* key, std::size_t otherwise) const {
    return has(key) ? member(key).size() : otherwise;
  }
  [[nodiscard]] std::size_t index(std::size_t count, const char* of) const {
    const std::size_t i = size();
    if (i >= count) {
      fail("index " + std::to_string(i) + " of " + of + " is out of range",
           count == 0 ? std::string("there are none") : "0 to " + std::to_string(count - 1));
    }
    return i;
  }
  [[nodiscard]] std::optional<std::size_t> optional_index(const char* key, std::size_t count,
                                                          const char* of) const {
    if (!has(key)) return std::nullopt;
    return member(key).index(count, of);
  }
  [[nodiscard]] std::string text() const {
    if (!value_.is_string()) fail(std::string("is of type ") + value_.type_name(), "string");
    return value_.get<std::string>();
  }
  [[nodiscard]] std::string text(const char* key) const {
    return has(key) ? member(key).text() : std::string();
  }
  template <int N>
  [[nodiscard]] Eigen::Matrix<double, N, 1> numbers() const {
    const std::vector<At> list = elements();
    if (list.size() != N)
      fail("has " + std::to_string(list.size()) + " numbers", std::to_string(N));
    Eigen::Matrix<double, N, 1> x;
    for (int i = 0; i < N; ++i) x[i] = list[i].number();
    return x;
  }
  /// Numbers of an array of any length that may be absent.
  [[nodiscard]] std::vector<double> all_numbers(const char* key) const {
    std::vector<double> numbers;
    for (const At& element : elements(key)) numbers.push_back(element.number());
    return numbers;
  }

 private:
  [[nodiscard]] double number() const {
    if (!value_.is_number()) fail("is not a number");
    const double x = value_.get<double>();
    if (!std::isfinite(x)) fail("is not finite");
    return x;
  }
  const json& value_;
  std::string pointer_;
  const std::filesystem::path& file_;
};

Component component_type(const At& at) {
  switch (at.size()) {
    case 5120:
    case 5121:
    case 5122:
    case 5123:
    case 5125:
    case 5126:
      return static_cast<Component>(at.size());
    default:
      at.fail("component type " + std::to_string(at.size()), "5120, 5121, 5122, 5123, 5125, 5126");
  }
}

void parse_buffers(const At& root, const Container& container, bool other_files, Model& model) {
  for (const At& at : root.elements("buffers")) {
    Buffer buffer;
    buffer.length = at.object().member("byteLength").size();
    if (at.has("uri")) {
      const At uri = at.member("uri");
      const std::string where =
          place(model, "/buffers/" + std::to_string(model.buffers.size()) + "/uri");
      buffer.file = file_of_uri(uri.text(), model.file, where);
      if (buffer.file && !other_files) uri.fail("refers to another file");
      buffer.bytes = buffer.file ? read_bytes(*buffer.file) : decode_data_uri(uri.text(), where);
    } else if (model.buffers.empty() && container.has_binary) {
      buffer.bytes = container.binary;
    } else {
      at.fail("has no URI and the file has no binary chunk for it");
    }
    if (buffer.bytes.size() < buffer.length) {
      at.fail("announces " + std::to_string(buffer.length) + " bytes and has " +
              std::to_string(buffer.bytes.size()));
    }
    model.buffers.push_back(std::move(buffer));
  }
}

void parse_views(const At& root, Model& model) {
  for (const At& at : root.elements("bufferViews")) {
    BufferView view;
    view.buffer = at.object().member("buffer").index(model.buffers.size(), "buffers");
    view.offset = at.size("byteOffset", 0);
    view.length = at.member("byteLength").size();
    if (view.offset + view.length > model.buffers[view.buffer].length) {
      at.fail("ends at byte " + std::to_string(view.offset + view.length) + " of buffer " +
                  std::to_string(view.buffer),
              "at most " + std::to_string(model.buffers[view.buffer].length));
    }
    if (at.has("byteStride")) {
      view.stride = at.member("byteStride").size();
      if (*view.stride < 4 || *view.stride > 252) {
        at.member("byteStride").fail("is " + std::to_string(*view.stride), "4 to 252");
      }
    }
    model.views.push_back(view);
  }
}

SparseValues parse_sparse(const At& at, const Model& model) {
  SparseValues sparse;
  sparse.count = at.object().member("count").size();
  const At indices = at.member("indices").object();
  const At values = at.member("values").object();
  sparse.index_view = indices.member("bufferView").index(model.views.size(), "bufferViews");
  sparse.index_offset = indices.size("byteOffset", 0);
  sparse.index_type = component_type(indices.member("componentType"));
  if (sparse.index_type != Component::u8 && sparse.index_type != Component::u16 &&
      sparse.index_type != Component::u32) {
    indices.member("componentType").fail("sparse indices are not unsigned", "5121, 5123, 5125");
  }
  sparse.value_view = values.member("bufferView").index(model.views.size(), "bufferViews");
  sparse.value_offset = values.size("byteOffset", 0);
  return sparse;
}

void parse_accessors(const At& root, Model& model) {
  static const std::map<std::string, int> kColumns{
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  for (const At& at : root.elements("accessors")) {
    Accessor accessor;
    accessor.view = at.object().optional_index("bufferView", model.views.size(), "bufferViews");
    accessor.offset = at.size("byteOffset", 0);
    accessor.component = component_type(at.member("componentType"));
    if (at.has("normalized")) {
      const At flag = at.member("normalized");
      if (!flag.value().is_boolean()) flag.fail("is not a boolean", "true or false");
      accessor.normalized = flag.value().get<bool>();
    }
    accessor.count = at.member("count").size();
    if (accessor.count == 0) at.member("count").fail("is 0", "at least 1");
    const std::string type = at.member("type").text();
    const auto columns = kColumns.find(type);
    if (columns == kColumns.end())
      at.member("type").fail("is '" + type.substr(0, 40) + "'",
                             "SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4");
    accessor.columns = columns->second;
    accessor.is_matrix = type.starts_with("MAT");
    if (at.has("sparse")) {
      accessor.sparse = parse_sparse(at.member("sparse"), model);
      if (accessor.sparse->count == 0 || accessor.sparse->count > accessor.count)
        at.member("sparse").member("count").fail("is " + std::to_string(accessor.sparse->count),
                                                 "1 to " + std::to_string(accessor.count));
    }
    model.accessors.push_back(accessor);
  }
}

Primitive parse_primitive(const At& at, const Model& model) {
  Primitive primitive;
  const std::size_t mode = at.object().size("mode", 4);
  if (mode > 6) at.member("mode").fail("is " + std::to_string(mode), "0 to 6");
  primitive.mode = static_cast<int>(mode);
  primitive.indices = at.optional_index("indices", model.accessors.size(), "accessors");
  for (const At& target : at.elements("targets")) {
    primitive.targets.push_back(
        target.object().optional_index("POSITION", model.accessors.size(), "accessors"));
  }
  const At attributes = at.member("attributes").object();
  for (const auto& [name, value] : attributes.value().items()) {
    primitive.attributes[name] =
        attributes.member(name.c_str()).index(model.accessors.size(), "accessors");
  }
  return primitive;
}

void parse_meshes(const At& root, Model& model) {
  for (const At& at : root.elements("meshes")) {
    Mesh mesh;
    mesh.name = at.object().text("name");
    for (const At& primitive : at.member("primitives").elements())
      mesh.primitives.push_back(parse_primitive(primitive, model));
    if (mesh.primitives.empty()) at.member("primitives").fail("is empty", "at least one");
    mesh.weights = at.all_numbers("weights");
    model.meshes.push_back(std::move(mesh));
  }
}

void parse_local_transform(const At& at, Node& node) {
  if (at.has("matrix")) {
    const Eigen::Matrix<double, 16, 1> m = at.member("matrix").numbers<16>();
    const Eigen::Map<const Eigen::Matrix4d> columns(m.data());
    if ((columns.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-6)
      at.member("matrix").fail("is not affine", "last row 0 0 0 1");
    node.matrix = Eigen::Affine3d(columns);
  }
  if (at.has("translation")) node.translation = at.member("translation").numbers<3>();
  if (at.has("scale")) node.scale = at.member("scale").numbers<3>();
  if (at.has("rotation")) {
    const Eigen::Vector4d xyzw = at.member("rotation").numbers<4>();
    if (!(xyzw.norm() > 1e-6)) at.member("rotation").fail("has no length", "a unit quaternion");
    node.rotation = Eigen::Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]).normalized();
  }
}

/// Parents before children; a node met twice has two parents or is its own ancestor.
void order_nodes(const At& root, Model& model) {
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    for (const std::size_t child : model.nodes[i].children) {
      std::optional<std::size_t>& parent = model.nodes[child].parent;
      if (parent || child == i) {
        root.fail(
            "the hierarchy is no tree: node " + std::to_string(child) + " is a child of " +
                (child == i ? "itself"
                            : "nodes " + std::to_string(*parent) + " and " + std::to_string(i)),
            "every node has at most one parent");
      }
      parent = i;
    }
  }
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (!model.nodes[i].parent) model.node_order.push_back(i);
  }
  for (std::size_t k = 0; k < model.node_order.size(); ++k) {
    const auto& children = model.nodes[model.node_order[k]].children;
    model.node_order.insert(model.node_order.end(), children.begin(), children.end());
  }
  if (model.node_order.size() != model.nodes.size()) {
    std::vector<bool> reached(model.nodes.size());
    for (const std::size_t i : model.node_order) reached[i] = true;
    const auto first = std::find(reached.begin(), reached.end(), false) - reached.begin();
    root.fail("the hierarchy is cyclic: node " + std::to_string(first) + " is its own ancestor");
  }
}

bool is_hidden(const At& node) {
  constexpr const char* kVisibility = "KHR_node_visibility";
  if (!node.has("extensions")) return false;
  const At extensions = node.member("extensions").object();
  if (!extensions.has(kVisibility)) return false;
  const At visibility = extensions.member(kVisibility).object();
  return visibility.has("visible") && visibility.member("visible").value() == false;
}

void parse_nodes(const At& root, std::size_t skin_count, Model& model) {
  const std::vector<At> list = root.elements("nodes");
  for (const At& at : list) {
    Node node;
    node.name = at.object().text("name");
    node.mesh = at.optional_index("mesh", model.meshes.size(), "meshes");
    node.skin = at.optional_index("skin", skin_count, "skins");
    for (const At& child : at.elements("children"))
      node.children.push_back(child.index(list.size(), "nodes"));
    node.weights = at.all_numbers("weights");
    node.is_hidden = is_hidden(at);
    parse_local_transform(at, node);
    model.nodes.push_back(std::move(node));
  }
  order_nodes(list.empty() ? root : root.member("nodes"), model);
}

void parse_skins(const At& root, Model& model) {
  for (const At& at : root.elements("skins")) {
    Skin skin;
    skin.name = at.object().text("name");
    std::set<std::size_t> seen;
    for (const At& joint : at.member("joints").elements()) {
      skin.joints.push_back(joint.index(model.nodes.size(), "nodes"));
      if (!seen.insert(skin.joints.back()).second)
        joint.fail("node " + std::to_string(skin.joints.back()) + " is a joint twice");
    }
    if (skin.joints.empty()) at.member("joints").fail("is empty", "at least one joint");
    skin.inverse_bind_matrices =
        at.optional_index("inverseBindMatrices", model.accessors.size(), "accessors");
    model.skins.push_back(std::move(skin));
  }
}

void parse_animations(const At& root, Model& model) {
  for (const At& at : root.elements("animations")) {
    Animation animation;
    animation.name = at.object().text("name");
    for (const At& s : at.member("samplers").elements()) {
      Sampler sampler;
      sampler.input = s.object().member("input").index(model.accessors.size(), "accessors");
      sampler.output = s.member("output").index(model.accessors.size(), "accessors");
      if (s.has("interpolation")) sampler.interpolation = s.member("interpolation").text();
      if (sampler.interpolation != "LINEAR" && sampler.interpolation != "STEP" &&
          sampler.interpolation != "CUBICSPLINE") {
        s.member("interpolation")
            .fail("is '" + sampler.interpolation.substr(0, 40) + "'", "LINEAR, STEP, CUBICSPLINE");
      }
      animation.samplers.push_back(sampler);
    }
    for (const At& c : at.member("channels").elements()) {
      Channel channel;
      channel.sampler = c.object().member("sampler").index(animation.samplers.size(), "samplers");
      const At target = c.member("target").object();
      channel.node = target.optional_index("node", model.nodes.size(), "nodes");
      channel.path = target.member("path").text();
      animation.channels.push_back(channel);
    }
    model.animations.push_back(std::move(animation));
  }
}

void note_ignored(const At& root, Model& model) {
  for (const char* key : {"cameras", "materials", "textures", "images"}) {
    const std::size_t n = root.elements(key).size();
    if (n > 0) model.ignored.push_back(std::to_string(n) + " " + key);
  }
  for (const At& at : root.elements("extensionsRequired")) {
    const std::string name = at.text();
    if (is_read_without(name)) continue;
    at.fail("the file requires the extension '" + name.substr(0, 60) + "'",
            way_out_of_extension(name));
  }
  for (const At& at : root.elements("extensionsUsed")) {
    const std::string loss = loss_without_extension(at.text());
    model.ignored.push_back("extension " + at.text() + (loss.empty() ? "" : ": " + loss));
  }
}

/// Nodes are shown with their parents, unless they are hidden, and with them their children.
void mark_shown(Model& model) {
  for (const std::size_t i : model.node_order) {
    Node& node = model.nodes[i];
    const bool with_parent = node.parent && model.nodes[*node.parent].in_scene;
    const bool below_hidden = node.parent && !with_parent && model.scene.empty();
    node.in_scene = !node.is_hidden && !below_hidden && (node.in_scene || with_parent);
  }
}

/// Marks the nodes of the scene that is shown: that of `scene`, else the first, as other programs
/// take it. A file without scenes is a library, of which everything is read.
void parse_scenes(const At& root, Model& model) {
  const std::vector<At> scenes = root.elements("scenes");
  std::vector<std::vector<std::size_t>> roots;
  for (const At& scene : scenes) {
    roots.emplace_back();
    for (const At& node : scene.object().elements("nodes"))
      roots.back().push_back(node.index(model.nodes.size(), "nodes"));
  }
  const auto named = root.optional_index("scene", scenes.size(), "scenes");
  if (scenes.empty()) return mark_shown(model);
  const std::size_t shown = named.value_or(0);
  const std::string name = scenes[shown].text("name");
  model.scene = "scene " + std::to_string(shown) + (name.empty() ? "" : " '" + name + "'") +
                (!named && scenes.size() > 1
                     ? ", the first of " + std::to_string(scenes.size()) + " as the file names none"
                     : "");
  for (Node& node : model.nodes) node.in_scene = false;
  for (const std::size_t node : roots[shown]) model.nodes[node].in_scene = true;
  mark_shown(model);
}

void require_version(const At& asset) {
  const std::string version = asset.member("version").text();
  if (!version.starts_with("2.")) {
    asset.member("version").fail("is '" + version.substr(0, 20) + "'",
                                 "2.x; Blender or assimp convert glTF 1.0");
  }
  const std::string least = asset.text("minVersion");
  if (least.empty() || least == "2.0" || least.starts_with("1.")) return;
  asset.member("minVersion")
      .fail("the file needs a reader of glTF " + least.substr(0, 20),
            "2.0, the version that is read");
}

}  // namespace

std::string place(const Model& model, const std::string& pointer) {
  return model.file.string() + ": " + pointer;
}

Model parse_gltf(const std::vector<std::byte>& bytes, const std::filesystem::path& file,
                 bool other_files_allowed) {
  const Container container = split_container(bytes, file);
  require_shallow_json(container.json, file.string());
  json document;
  try {
    document = json::parse(container.json);
  } catch (const json::exception& e) {
    throw Error(std::string("no valid JSON: ") + e.what(), file.string());
  }
  Model model;
  model.file = file;
  const At root(document, "", file);
  require_version(root.object().member("asset").object());
  note_ignored(root, model);
  parse_buffers(root, container, other_files_allowed, model);
  parse_views(root, model);
  parse_accessors(root, model);
  parse_meshes(root, model);
  parse_nodes(root, root.elements("skins").size(), model);
  parse_skins(root, model);
  parse_animations(root, model);
  parse_scenes(root, model);
  return model;
}

Model parse_gltf(const std::filesystem::path& file) {
  return parse_gltf(read_bytes(file), file, true);
}

}  // namespace geoprior::gltf
