#include "experiments/assembly/files/assembly_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>

#include "core/angles.h"
#include "core/error.h"
#include "core/limits.h"
#include "experiments/assembly/files/primitives.h"
#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/text/letters.h"
#include "testbed/formats/text/lines.h"
#include "testbed/formats/text/parsed_text.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/joined.h"
#include "testbed/runner/names.h"
#include "testbed/runner/options/toml.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior::assembly {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// Most that a way may begin or end beside its port (m).
constexpr double kWayGap = 1e-3;
/// Most that a symmetry may carry a port beside another one (m, and 1 for its axes).
constexpr double kSymmetryGap = 1e-6;

/// A file that is being read, and what it names as its own place.
struct AssemblySource {
  std::string name;
  fs::path folder;
};

/// Everything read so far.
struct AssemblyReading {
  ReadAssemblies out;
  std::vector<fs::path> open;  ///< files that include one another, the outermost first
  std::set<fs::path> read;
  std::map<std::string, std::string, std::less<>> label_places, model_places;
  std::map<std::string, int, std::less<>> types;  ///< by label
  double vertices = 0;
};

/// Runs what knows no place and adds one to its errors.
template <class Action>
auto at_file_place(const std::string& place, const Action& action) {
  try {
    return action();
  } catch (const Error& e) {
    throw Error(e.what(), place);
  }
}

std::string pointer_step(std::string_view key) {
  std::string out = "/";
  for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

/// A JSON value as the tree that options are read from.
TomlNode tree_of_json(const nlohmann::json& json, const std::string& file,
                      const std::string& pointer) {
  using Kind = TomlNode::Kind;
  TomlNode node;
  node.place = file + ": " + (pointer.empty() ? "/" : pointer);
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      node.keys.push_back(key);
      node.items.push_back(tree_of_json(value, file, pointer + pointer_step(key)));
    }
  } else if (json.is_array()) {
    node.kind = Kind::array;
    for (std::size_t i = 0; i < json.size(); ++i)
      node.items.push_back(tree_of_json(json[i], file, pointer + "/" + std::to_string(i)));
  } else if (json.is_boolean()) {
    node.kind = Kind::boolean;
    node.boolean = json.get<bool>();
  } else if (json.is_number_integer() &&
             (!json.is_number_unsigned() || json.get<std::uint64_t>() <= INT64_MAX)) {
    node.kind = Kind::integer;
    node.integer = json.get<std::int64_t>();
  } else if (json.is_number()) {
    node.kind = Kind::real;
    node.real = json.get<double>();
  } else if (json.is_string()) {
    node.kind = Kind::text;
    node.text = json.get<std::string>();
  } else {
    throw Error("is null", node.place, "a text, a number, true or false, an array, an object");
  }
  return node;
}

/// Options know lists of numbers, no lists of points: [[x, y], [x, y]] becomes [x, y, x, y].
void flatten_points(TomlNode& table, const std::string& key, std::size_t size) {
  TomlNode* list = table.find(key);
  if (list == nullptr) return;
  const std::string allowed = size == 3 ? "[[x, y, z], …]" : "[[x, y], …]";
  const std::string where = list->place + ": " + key;
  if (list->kind != TomlNode::Kind::array) throw Error("is " + list->kind_name(), where, allowed);
  std::vector<TomlNode> numbers;
  for (TomlNode& point : list->items) {
    if (point.kind != TomlNode::Kind::array || point.items.size() != size)
      throw Error("has an element that is no point", point.place + ": " + key, allowed);
    for (TomlNode& x : point.items) numbers.push_back(std::move(x));
  }
  list->items = std::move(numbers);
}

/// Does something with each element of a list; what is no list the option reader refuses.
template <class Action>
void for_each_item(TomlNode& table, const std::string& key, const Action& action) {
  TomlNode* list = table.find(key);
  if (list == nullptr || list->kind != TomlNode::Kind::array) return;
  for (TomlNode& item : list->items) action(item);
}

void flatten_all_points(TomlNode& root) {
  for_each_item(root, "part", [](TomlNode& part) {
    for_each_item(part, "ways", [](TomlNode& way) { flatten_points(way, "points", 3); });
    for_each_item(part, "solids", [](TomlNode& solid) {
      flatten_points(solid, "points", 3);
      flatten_points(solid, "outline", 2);
    });
  });
}

Vector3d file_vector(const std::array<double, 3>& x) { return {x[0], x[1], x[2]}; }

std::vector<Vector3d> file_points(const std::vector<double>& numbers) {
  std::vector<Vector3d> out;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    out.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return out;
}

std::vector<Eigen::Vector2d> file_plane_points(const std::vector<double>& numbers) {
  std::vector<Eigen::Vector2d> out;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)
    out.emplace_back(numbers[i], numbers[i + 1]);
  return out;
}

PortType port_of(const PortEntry& entry, const std::string& place) {
  require_plain_name(entry.name, "a port", place);
  const Vector3d out = file_vector(entry.out).normalized(), up = file_vector(entry.up).normalized();
  const Vector3d side = up.cross(out);
  if (!(side.norm() > 1e-6))
    throw Error("port '" + entry.name + "' has no frame", place,
                "'out' and 'up' in two directions, neither of length 0");
  PortType port;
  port.name = entry.name;
  port.frame.translation() = file_vector(entry.at);
  port.frame.linear().col(0) = out;
  port.frame.linear().col(1) = side.normalized();
  port.frame.linear().col(2) = out.cross(side.normalized());
  return port;
}

std::vector<std::string> port_names(const PartType& type) {
  std::vector<std::string> names;
  for (const PortType& port : type.ports) names.push_back(port.name);
  return names;
}

/// Index of a port of that name.
int port_index(const PartType& type, std::string_view name, const std::string& place) {
  for (std::size_t i = 0; i < type.ports.size(); ++i)
    if (type.ports[i].name == name) return static_cast<int>(i);
  throw Error("part '" + type.label + "' has no port '" + std::string(name) + "'", place,
              allowed_names(name, port_names(type)));
}

Way way_of(const PartType& type, const WayEntry& entry, const std::string& place) {
  Way way;
  way.points = file_points(entry.points);
  if (way.points.size() < 2)
    throw Error("has a way of " + std::to_string(way.points.size()) + " points", place,
                "two or more");
  const auto end = [&](const std::string& name, const Vector3d& x) {
    if (name.empty()) return Way::kInside;
    const int port = port_index(type, name, place);
    const double gap = (x - type.ports[port].frame.translation()).norm();
    if (gap > kWayGap)
      throw Error("has a way that is " + std::to_string(gap) + " m off its port '" + name + "'",
                  place, "within 0.001 m");
    return port;
  };
  way.from = end(entry.from, way.points.front());
  way.to = end(entry.to, way.points.back());
  return way;
}

Symmetry symmetry_of(const PartType& type, const std::string& text, const std::string& place) {
  std::vector<std::string_view> words;
  split_words(text, words);
  Symmetry out;
  for (const std::string_view word : words) out.ports.push_back(port_index(type, word, place));
  std::vector<int> sorted = out.ports;
  std::sort(sorted.begin(), sorted.end());
  if (sorted.size() != type.ports.size() ||
      std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    throw Error("is no permutation of the ports", place,
                "each once: \"" + joined(port_names(type), " ") + "\" in another order");
  if (sorted == out.ports)
    throw Error("is a symmetry that moves nothing", place, "another order of the ports");
  const auto frame = [&](int port) -> const Pose& { return type.ports[port].frame; };
  out.motion = frame(out.ports[0]) * frame(0).inverse();
  for (std::size_t i = 0; i < out.ports.size(); ++i) {
    const Pose moved = out.motion * type.ports[i].frame;
    if ((moved.matrix() - frame(out.ports[i]).matrix()).cwiseAbs().maxCoeff() > kSymmetryGap)
      throw Error("no rigid motion carries port '" + type.ports[i].name + "' to '" +
                      type.ports[out.ports[i]].name + "' and the others so",
                  place, "ports whose frames are carried onto each other");
  }
  return out;
}

/// Symmetries are used as a group: one after another is one again. Each is known by where it
/// carries the first port.
void require_group(const PartType& type, const std::string& place) {
  std::set<int> images{0};
  for (const Symmetry& symmetry : type.symmetries)
    if (!images.insert(symmetry.ports[0]).second)
      throw Error("has one symmetry twice", place, "different ones");
  for (const Symmetry& a : type.symmetries)
    for (const Symmetry& b : type.symmetries) {
      if (images.contains(b.ports[a.ports[0]])) continue;
      std::vector<std::string> names;
      for (const int port : a.ports) names.push_back(type.ports[b.ports[port]].name);
      throw Error("are symmetries whose sequence is none of them", place,
                  "with them also \"" + joined(names, " ") + "\"");
    }
}

Pose solid_pose(const SolidEntry& solid) {
  Pose pose = Pose::Identity();
  pose.translation() = file_vector(solid.at);
  for (int axis = 2; axis >= 0; --axis)
    pose.rotate(Eigen::AngleAxisd(solid.turn_deg[axis] * kDegree, Vector3d::Unit(axis)));
  return pose;
}

/// What is swept along its own points, or along each way of the part.
Body swept_solid(const SolidEntry& solid, const PartType& type) {
  const bool is_channel = solid.kind == SolidKind::channel;
  const SweptShape shape{solid.width, is_channel ? solid.depth : solid.height, solid.wall,
                         solid.offset, solid.round};
  std::vector<std::vector<Vector3d>> lines;
  if (!solid.points.empty()) lines.push_back(file_points(solid.points));
  if (lines.empty())
    for (const Way& way : type.ways) lines.push_back(way.points);
  if (lines.empty()) throw Error("has no 'points'", "", "points, or a part with ways");
  Body body;
  for (const std::vector<Vector3d>& line : lines)
    append(body, is_channel ? channel_body(line, shape) : rail_body(line, shape), Pose::Identity());
  return body;
}

Body body_of_solid(const SolidEntry& solid, const PartType& type) {
  switch (solid.kind) {
    case SolidKind::box:
      return box_body(file_vector(solid.size), solid.round);
    case SolidKind::cylinder:
      return cylinder_body(solid.radius, solid.top_radius.value_or(solid.radius), solid.length,
                           solid.round);
    case SolidKind::sphere:
      return sphere_body(solid.radius);
    case SolidKind::lathe:
      return lathe_body(file_plane_points(solid.outline));
    case SolidKind::prism:
      return prism_body(file_plane_points(solid.outline), solid.height, solid.round);
    case SolidKind::channel:
    case SolidKind::rail:
      return swept_solid(solid, type);
  }
  return {};
}

/// The mesh of a file, with one box around it.
Body body_of_mesh(const fs::path& file, const std::string& place, AssemblyReading& reading) {
  const MeshFile read =
      at_file_place(place, [&] { return read_mesh_file(file, reading.out.warnings); });
  reading.out.files.push_back(file);
  Body body;
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i < read.mesh.V.rows(); ++i) {
    body.vertices.emplace_back(read.mesh.V.row(i).transpose());
    box.extend(body.vertices.back());
  }
  for (Eigen::Index i = 0; i < read.mesh.F.rows(); ++i)
    body.triangles.emplace_back(read.mesh.F.row(i).transpose());
  if (!box.isEmpty())
    body.boxes.push_back({Pose(Eigen::Translation3d(box.center())), box.sizes() / 2});
  return body;
}

/// Members of a list of tables, or of texts, for their places.
const std::vector<TomlNode>& file_items(const TomlNode& table, const std::string& key) {
  static const std::vector<TomlNode> kNone;
  const TomlNode* list = table.find(key);
  return list == nullptr ? kNone : list->items;
}

void read_part_body(PartType& type, const PartEntry& entry, const TomlNode& node,
                    const AssemblySource& source, AssemblyReading& reading) {
  Body body;
  if (!entry.mesh.empty())
    body = body_of_mesh(source.folder / entry.mesh, place_of(node, "mesh"), reading);
  reading.vertices += static_cast<double>(body.vertices.size());
  for (std::size_t i = 0; i < entry.solids.size(); ++i) {
    const std::string& place = file_items(node, "solids")[i].place;
    const SolidEntry& solid = entry.solids[i];
    const Body piece = at_file_place(place, [&] { return body_of_solid(solid, type); });
    reading.vertices += static_cast<double>(piece.vertices.size());
    require_vertices(reading.vertices, place);
    append(body, piece, solid_pose(solid));
  }
  type.mesh = body.mesh();
  type.boxes = std::move(body.boxes);
}

void read_part_entry(const PartEntry& entry, const TomlNode& node, const AssemblySource& source,
                     AssemblyReading& reading) {
  require_plain_name(entry.label, "a label", place_of(node, "label"));
  const auto [first, is_new] = reading.label_places.emplace(entry.label, place_of(node, "label"));
  if (!is_new)
    throw Error("'" + entry.label + "' is the label of another part", place_of(node, "label"),
                "a name beside that at " + first->second);
  PartType type;
  type.label = entry.label;
  if (entry.ports.empty())
    throw Error("part '" + entry.label + "' is a label without ports", place_of(node, "ports"),
                "at least one port, or it cannot be joined");
  std::set<std::string> names;
  for (std::size_t i = 0; i < entry.ports.size(); ++i) {
    const std::string& place = file_items(node, "ports")[i].place;
    type.ports.push_back(port_of(entry.ports[i], place));
    if (!names.insert(entry.ports[i].name).second)
      throw Error("'" + entry.ports[i].name + "' is the name of another port of the part", place,
                  "names that differ");
  }
  for (std::size_t i = 0; i < entry.ways.size(); ++i)
    type.ways.push_back(way_of(type, entry.ways[i], file_items(node, "ways")[i].place));
  for (std::size_t i = 0; i < entry.symmetries.size(); ++i)
    type.symmetries.push_back(
        symmetry_of(type, entry.symmetries[i], file_items(node, "symmetries")[i].place));
  require_group(type, place_of(node, "symmetries"));
  read_part_body(type, entry, node, source, reading);
  reading.types[type.label] = static_cast<int>(reading.out.set.types.size());
  reading.out.set.types.push_back(std::move(type));
}

/// Parts of a model by what the file calls them.
using PartIds = std::map<std::string, int, std::less<>>;

std::vector<std::string> listed_names(const PartIds& ids) {
  std::vector<std::string> names;
  for (const auto& [name, index] : ids) names.push_back(name);
  return names;
}

int part_of_id(const PartIds& ids, std::string_view id, const std::string& place) {
  const auto at = ids.find(id);
  if (at == ids.end())
    throw Error("there is no part '" + std::string(id) + "'", place,
                allowed_names(id, listed_names(ids)));
  return at->second;
}

PartIds read_model_parts(Assembly& model, const ModelEntry& entry, const TomlNode& node,
                         const AssemblyReading& reading) {
  PartIds ids;
  for (std::size_t i = 0; i < entry.parts.size(); ++i) {
    const TomlNode& item = file_items(node, "parts")[i];
    const auto& [id, label] = entry.parts[i];
    require_plain_name(id, "an id", place_of(item, "id"));
    if (!ids.emplace(id, static_cast<int>(i)).second)
      throw Error("'" + id + "' is the id of another part", place_of(item, "id"),
                  "ids that differ");
    const auto type = reading.types.find(label);
    if (type == reading.types.end())
      throw Error("there is no part with the label '" + label + "'", place_of(item, "part"),
                  allowed_names(label, listed_names(reading.types)));
    model.parts.push_back({type->second, Pose::Identity()});
  }
  return ids;
}

/// "id.port" as a port of the model.
PortRef port_ref_of(std::string_view text, const Assembly& model, const PartIds& ids,
                    const AssemblySet& set, const std::string& place) {
  const std::size_t dot = text.find('.');
  if (dot == std::string_view::npos)
    throw Error("'" + std::string(text) + "' names no port", place, "\"id.port id.port\"");
  const int part = part_of_id(ids, text.substr(0, dot), place);
  return {part, port_index(set.types[model.parts[part].type], text.substr(dot + 1), place)};
}

void read_model_joints(Assembly& model, const ModelEntry& entry, const TomlNode& node,
                       const PartIds& ids, const AssemblySet& set) {
  std::map<PortRef, std::string> used;
  for (std::size_t i = 0; i < entry.joints.size(); ++i) {
    const std::string& joint = entry.joints[i];
    const std::string& place = file_items(node, "joints")[i].place;
    std::vector<std::string_view> words;
    split_words(joint, words);
    if (words.size() != 2) throw Error("'" + joint + "' is no joint", place, "\"id.port id.port\"");
    Connection connection;
    for (const bool is_first : {true, false}) {
      const std::string_view word = words[is_first ? 0 : 1];
      const PortRef port = port_ref_of(word, model, ids, set, place);
      const auto [user, is_new] = used.emplace(port, joint);
      if (!is_new)
        throw Error("port '" + std::string(word) + "' is used twice", place,
                    "one joint a port; the other is \"" + user->second + "\"");
      (is_first ? connection.a : connection.b) = port;
    }
    model.connections.push_back(connection);
  }
}

/// Moves each component to where its part with a place is to be.
void place_components(Assembly& model, const ModelEntry& entry, const TomlNode& node,
                      const PartIds& ids) {
  const Components pieces = components(model);
  std::vector<std::optional<Pose>> motion(pieces.count);
  for (std::size_t i = 0; i < entry.place.size(); ++i) {
    const PlaceEntry& given = entry.place[i];
    const std::string place = place_of(file_items(node, "place")[i], "part");
    const int part = part_of_id(ids, given.part, place);
    std::optional<Pose>& its_motion = motion[pieces.of_part[part]];
    if (its_motion)
      throw Error("'" + given.part + "' hangs together with another part that has a place", place,
                  "one place for each piece of the model");
    Pose pose = Pose::Identity();
    pose.translation() = file_vector(given.at);
    pose.rotate(Eigen::AngleAxisd(given.turn_deg * kDegree, Vector3d::UnitZ()));
    its_motion = pose * model.parts[part].pose.inverse();
  }
  if (pieces.count == 1 && !motion[0]) motion[0] = Pose::Identity();
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    const std::optional<Pose>& its_motion = motion[pieces.of_part[i]];
    if (!its_motion)
      throw Error("model '" + model.name + "' is not in one piece, and that of part '" +
                      entry.parts[i].id + "' has no place",
                  place_of(node, "place"), "one place for each piece of the model");
    model.parts[i].pose = *its_motion * model.parts[i].pose;
  }
}

void read_model_entry(const ModelEntry& entry, const TomlNode& node, AssemblyReading& reading) {
  const std::string place = place_of(node, "name");
  require_plain_name(entry.name, "a model", place);
  const auto [first, is_new] = reading.model_places.emplace(entry.name, place);
  if (!is_new)
    throw Error("'" + entry.name + "' is the name of another model", place,
                "a name beside that at " + first->second);
  Assembly model;
  model.name = entry.name;
  const PartIds ids = read_model_parts(model, entry, node, reading);
  if (model.parts.empty())
    throw Error("model '" + entry.name + "' has no parts", place_of(node, "parts"),
                "at least one part");
  AssemblySet& set = reading.out.set;
  read_model_joints(model, entry, node, ids, set);
  place_parts(model, set.types);
  place_components(model, entry, node, ids);
  // The check is of a set: the types lend themselves to one with this model alone.
  AssemblySet alone{std::move(set.types), {model}};
  at_file_place(node.place, [&] { require_valid(alone); });
  set.types = std::move(alone.types);
  set.models.push_back(std::move(model));
}

void read_assembly_tree(TomlNode& root, const AssemblySource& source, AssemblyReading& reading);

TomlNode parse_assembly_tree(std::string_view text, const std::string& name, bool json) {
  return json ? tree_of_json(parse_json(text, name), name, "") : parse_toml_text(text, name);
}

bool is_json_file(const fs::path& file) {
  const std::string extension = lower(file.extension().string());
  if (extension != ".toml" && extension != ".json")
    throw Error("is no assembly file by its extension", file.string(), ".toml, .json");
  return extension == ".json";
}

/// Reads a file unless it was read before.
/// @param place  that names the file, "" for the first one
void read_assembly_once(const fs::path& file, const std::string& place, AssemblyReading& reading) {
  constexpr std::size_t kMostOpen = 100;
  std::error_code unknown;  // the path of a file that cannot be there stays as it is
  fs::path whole = fs::weakly_canonical(file, unknown);
  if (unknown) whole = file.lexically_normal();
  const auto opened = std::find(reading.open.begin(), reading.open.end(), whole);
  if (opened != reading.open.end()) {
    std::vector<std::string> chain;
    for (auto at = opened; at != reading.open.end(); ++at) chain.push_back(at->filename().string());
    throw Error("includes itself: " + joined(chain, " -> ") + " -> " + whole.filename().string(),
                place, "files that do not lead back");
  }
  if (reading.open.size() >= kMostOpen)
    throw Error("is a file included by 100 others, one by another", place, "fewer");
  if (!reading.read.insert(whole).second) return;
  const bool json = is_json_file(file);
  const std::string text = at_file_place(place, [&] { return read_text_file(file); });
  TomlNode root = parse_assembly_tree(text, file.string(), json);
  reading.out.files.push_back(file);
  reading.open.push_back(whole);
  read_assembly_tree(root, {file.string(), file.parent_path()}, reading);
  reading.open.pop_back();
}

void read_assembly_tree(TomlNode& root, const AssemblySource& source, AssemblyReading& reading) {
  flatten_all_points(root);
  AssemblyFile file;
  read_options(root, "", file);
  for (std::size_t i = 0; i < file.include.size(); ++i)
    read_assembly_once(source.folder / file.include[i], file_items(root, "include")[i].place,
                       reading);
  for (std::size_t i = 0; i < file.parts.size(); ++i)
    read_part_entry(file.parts[i], file_items(root, "part")[i], source, reading);
  for (std::size_t i = 0; i < file.models.size(); ++i)
    read_model_entry(file.models[i], file_items(root, "model")[i], reading);
}

ReadAssemblies finished_reading(AssemblyReading&& reading, const std::string& name) {
  if (reading.out.set.types.empty()) throw Error("has no parts", name, "[[part]] tables");
  return std::move(reading.out);
}

}  // namespace

ReadAssemblies read_assembly_file(const std::filesystem::path& file) {
  AssemblyReading reading;
  read_assembly_once(file, "", reading);
  return finished_reading(std::move(reading), file.string());
}

ReadAssemblies parse_assembly_file(std::string_view text, const std::string& name,
                                   const std::filesystem::path& folder, bool json) {
  AssemblyReading reading;
  TomlNode root = parse_assembly_tree(text, name, json);
  read_assembly_tree(root, {name, folder}, reading);
  return finished_reading(std::move(reading), name);
}

}  // namespace geoprior::assembly
