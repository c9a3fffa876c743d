#include "experiments/assembly/files/gltf_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "core/error.h"
#include "testbed/formats/gltf/container.h"

namespace geoprior::assembly {
namespace {

using nlohmann::json;

/// Where buffers and images begin in the chunk: no component of an accessor is larger.
constexpr std::size_t kGltfAlignment = 8;

/// Whether an extension of a node or of the document refers to no node.
bool is_free_of_nodes(const std::string& extension) {
  constexpr std::array<std::string_view, 5> kNames{"KHR_lights_punctual", "KHR_node_visibility",
                                                   "EXT_mesh_features", "EXT_structural_metadata",
                                                   "EXT_instance_features"};
  return extension.starts_with("KHR_materials_") || extension.starts_with("KHR_xmp") ||
         std::find(kNames.begin(), kNames.end(), extension) != kNames.end();
}

/// Leaves out extensions of an object that may refer to nodes, and adds their names.
void keep_free_extensions(json& owner, std::vector<std::string>& left_out) {
  const auto extensions = owner.find("extensions");
  if (extensions == owner.end() || !extensions->is_object()) return;
  json kept = json::object();
  for (const auto& [name, value] : extensions->items()) {
    if (is_free_of_nodes(name)) {
      kept[name] = value;
    } else if (std::find(left_out.begin(), left_out.end(), name) == left_out.end()) {
      left_out.push_back(name);
    }
  }
  if (kept.empty()) {
    owner.erase("extensions");
  } else {
    owner["extensions"] = std::move(kept);
  }
}

/// Without a skin, a mesh must not name joints.
void leave_out_skins(json& document) {
  for (json& mesh : document["meshes"])
    for (json& primitive : mesh["primitives"]) {
      json kept = json::object();
      for (const auto& [name, accessor] : primitive["attributes"].items())
        if (!name.starts_with("JOINTS_") && !name.starts_with("WEIGHTS_")) kept[name] = accessor;
      primitive["attributes"] = std::move(kept);
    }
}

void leave_out_motion(json& document, const std::string& file, std::vector<std::string>& warnings) {
  std::string list;
  for (const char* key : {"animations", "skins", "cameras"}) {
    const auto found = document.find(key);
    if (found == document.end()) continue;
    if (!found->empty())
      list += (list.empty() ? "" : ", ") + std::to_string(found->size()) + " " + key;
    if (std::string_view(key) == "skins" && document.contains("meshes")) leave_out_skins(document);
    document.erase(key);
  }
  std::vector<std::string> extensions;
  keep_free_extensions(document, extensions);
  if (document.contains("nodes"))
    for (json& node : document["nodes"]) {
      node.erase("skin");
      node.erase("camera");
      keep_free_extensions(node, extensions);
    }
  for (const std::string& name : extensions)
    list += (list.empty() ? "" : ", ") + ("extension " + name.substr(0, 60));
  if (!list.empty()) warnings.push_back(file + ": left out of what is written: " + list);
}

/// Appends bytes at the next aligned place, which is returned.
std::size_t append_aligned(std::span<const std::byte> bytes, std::string& binary) {
  const std::size_t at = (binary.size() + kGltfAlignment - 1) / kGltfAlignment * kGltfAlignment;
  binary.resize(at, '\0');
  binary.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return at;
}

void gather_buffers(const gltf::Model& model, json& document, std::string& binary) {
  std::vector<std::size_t> begin;
  for (const gltf::Buffer& buffer : model.buffers)
    begin.push_back(append_aligned(std::span(buffer.bytes).first(buffer.length), binary));
  for (std::size_t i = 0; i < model.views.size(); ++i) {
    json& view = document["bufferViews"][i];
    view["buffer"] = 0;
    view["byteOffset"] = begin[model.views[i].buffer] + model.views[i].offset;
    view.erase("extensions");
  }
}

/// Media type by the first bytes; empty when they are of no kind that glTF or an extension names.
std::string image_type(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\x89PNG")) return "image/png";
  if (text.starts_with("\xFF\xD8\xFF")) return "image/jpeg";
  if (text.starts_with("RIFF") && text.substr(std::min<std::size_t>(8, text.size()), 4) == "WEBP")
    return "image/webp";
  if (text.starts_with("\xABKTX 20")) return "image/ktx2";
  if (text.starts_with("DDS ")) return "image/vnd-ms.dds";
  return {};
}

void gather_images(const gltf::Model& model, bool other_files_allowed, json& document,
                   std::string& binary, ReadAssemblies& read) {
  if (!document.contains("images")) return;
  json& images = document["images"];
  for (std::size_t i = 0; i < images.size(); ++i) {
    json& image = images[i];
    const std::string where = gltf::place(model, "/images/" + std::to_string(i));
    if (!image.is_object()) throw Error("is not an object", where);
    const auto uri = image.find("uri");
    if (uri == image.end()) continue;
    if (!uri->is_string()) throw Error("is not a text", where + "/uri");
    const std::string& text = uri->get_ref<const std::string&>();
    const auto file = gltf::file_of_uri(text, model.file, where + "/uri");
    if (file && !other_files_allowed) throw Error("refers to another file", where + "/uri");
    const std::vector<std::byte> bytes =
        file ? gltf::read_bytes(*file) : gltf::decode_data_uri(text, where + "/uri");
    const std::string type = image_type(bytes);
    if (type.empty())
      throw Error("is no image of a known kind", where, "PNG, JPEG, WebP, KTX2, DDS");
    if (file) read.files.push_back(*file);
    const std::size_t at = append_aligned(bytes, binary);
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", at}, {"byteLength", bytes.size()}});
    image.erase("uri");
    image["bufferView"] = document["bufferViews"].size() - 1;
    image["mimeType"] = type;
  }
}

void append_glb_word(std::size_t word, std::string& out) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>((word >> (8 * i)) & 0xFF));
}

/// Column by column, of the node of a part in glTF's axes.
json matrix_of_part(const Pose& pose, const Eigen::Vector3d& scale) {
  const Eigen::Matrix3d to_gltf = z_up_of_gltf().transpose();
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = to_gltf * pose.linear() * to_gltf.transpose() * scale.asDiagonal();
  matrix.topRightCorner<3, 1>() = to_gltf * pose.translation();
  json out = json::array();
  for (int i = 0; i < 16; ++i) out.push_back(matrix.data()[i]);
  return out;
}

/// "wagon", "wagon.001", "wagon.002" and on.
std::string numbered_label(const std::string& label, int number) {
  if (number == 0) return label;
  std::array<char, 16> digits{};
  std::snprintf(digits.data(), digits.size(), ".%03d", number);
  return label + digits.data();
}

/// Appends copies of a part's nodes, its own first.
void add_copies(const json& source, const GltfTypeNodes& type, json& nodes) {
  std::map<int, std::size_t> copy_of;
  for (const int node : type.nodes) {
    const std::size_t number = nodes.size() + copy_of.size();
    copy_of.emplace(node, number);
  }
  for (const int node : type.nodes) {
    json copy = source[node];
    json children = json::array();
    if (copy.contains("children"))
      for (const json& child : copy["children"]) {
        const auto found = copy_of.find(child.get<int>());
        if (found != copy_of.end()) children.push_back(found->second);
      }
    copy.erase("children");
    if (!children.empty()) copy["children"] = std::move(children);
    nodes.push_back(std::move(copy));
  }
}

}  // namespace

Eigen::Matrix3d z_up_of_gltf() {
  Eigen::Matrix3d turn;
  turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return turn;
}

GltfScene gather_gltf(const json& document, const gltf::Model& model, bool other_files_allowed,
                      ReadAssemblies& read) {
  GltfScene scene;
  scene.file = model.file.string();
  auto gathered = std::make_shared<json>(document);
  leave_out_motion(*gathered, scene.file, read.warnings);
  gather_buffers(model, *gathered, scene.binary);
  gather_images(model, other_files_allowed, *gathered, scene.binary, read);
  gathered->erase("buffers");
  if (!scene.binary.empty())
    (*gathered)["buffers"] = json::array({{{"byteLength", scene.binary.size()}}});
  scene.document = std::move(gathered);
  return scene;
}

std::string glb_bytes(const json& document, std::string_view binary, const std::string& name) {
  std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t padded = (binary.size() + 3) / 4 * 4;
  const std::size_t size = 20 + text.size() + (padded > 0 ? 8 + padded : 0);
  if (size > std::numeric_limits<std::uint32_t>::max())
    throw Error("the file would have " + std::to_string(size) + " bytes", name, "at most 4 GB");
  std::string out;
  out.reserve(size);
  for (const std::size_t word :
       {std::size_t{0x46546C67}, std::size_t{2}, size, text.size(), std::size_t{0x4E4F534A}})
    append_glb_word(word, out);
  out += text;
  if (padded > 0) {
    append_glb_word(padded, out);
    append_glb_word(0x004E4942, out);
    out += binary;
    out.resize(size, '\0');
  }
  return out;
}

std::string assembly_glb(const GltfScene& scene, const Assembly& assembly) {
  const std::string where = scene.file + ", variation '" + assembly.name + "'";
  if (assembly.parts.empty()) throw Error("has no parts", where, "at least one");
  json document = *scene.document;
  const json source = std::move(document["nodes"]);
  json nodes = json::array();
  json roots = json::array();
  std::vector<int> copies(scene.types.size(), 0);
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
    const PlacedPart& part = assembly.parts[i];
    const std::string part_title = where + ", part " + std::to_string(i);
    if (part.type < 0 || part.type >= static_cast<int>(scene.types.size()))
      throw Error("is of type " + std::to_string(part.type), part_title,
                  "0 to " + std::to_string(scene.types.size() - 1));
    if (!part.pose.matrix().allFinite()) throw Error("has a pose that is not finite", part_title);
    const GltfTypeNodes& type = scene.types[part.type];
    const std::size_t root = nodes.size();
    add_copies(source, type, nodes);
    for (const char* key : {"translation", "rotation", "scale"}) nodes[root].erase(key);
    nodes[root]["matrix"] = matrix_of_part(part.pose, type.scale);
    nodes[root]["name"] = numbered_label(type.label, copies[part.type]++);
    roots.push_back(root);
  }
  document["nodes"] = std::move(nodes);
  document["scene"] = 0;
  document["scenes"] = json::array({{{"name", assembly.name}, {"nodes", std::move(roots)}}});
  return glb_bytes(document, scene.binary, where);
}

}  // namespace geoprior::assembly
