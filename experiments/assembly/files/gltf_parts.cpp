#include "experiments/assembly/files/gltf_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/angles.h"
#include "core/error.h"
#include "testbed/formats/gltf/container.h"
#include "testbed/formats/gltf/extensions.h"
#include "testbed/formats/gltf/reader.h"
#include "testbed/formats/gltf/skin.h"
#include "testbed/formats/text/parsed_text.h"

namespace geoprior::assembly {
namespace {

using nlohmann::json;

constexpr double kMostGltfJoint = 5e-3;         // m
constexpr double kMostGltfJointOfScene = 5e-3;  // of the scene's size
constexpr double kNearlyGltfJoint = 5;          // times the distance of joined ports
constexpr double kMostOpposedDeg = 10;
constexpr double kMostRollDeg = 20;
constexpr double kSameOfScene = 1e-4;  // of the scene's size
constexpr double kSamePortDeg = .1;
constexpr double kSameScale = 1e-4;  // relative

/// A port as its node stands in the world.
struct FoundPort {
  int node = 0;
  std::string name;
  Pose world = Pose::Identity();
};

/// A part as its node stands in the world.
struct FoundPart {
  int node = 0;
  std::string label;
  Pose pose = Pose::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  std::vector<FoundPort> ports;  ///< by name
  std::vector<int> nodes;        ///< its own first, parents before children
  int type = -1;
};

/// Vertices of a primitive in the mesh of the whole scene.
struct PrimitiveVertices {
  int first = 0;
  int count = 0;
};

/// What the mesh of a node is in the mesh of the whole scene.
struct NodeSurface {
  std::vector<PrimitiveVertices> primitives;
  int first_triangle = 0;
  int triangle_count = 0;
};

/// The file, and what its scene shows.
struct SourceScene {
  const gltf::Model& model;
  const json& document;
  std::vector<Eigen::Affine3d> world;  ///< of the nodes, in glTF's axes
  TriMesh mesh;                        ///< of all nodes, z up
  std::vector<NodeSurface> surfaces;   ///< one a node
  double size = 0;                     ///< diagonal of the box around the parts (m)

  [[nodiscard]] std::string title(int node) const {
    const std::string& name = model.nodes[node].name;
    return "node " + (name.empty() ? std::to_string(node) : "'" + name.substr(0, 80) + "'");
  }
  [[nodiscard]] std::string where(int node) const {
    return model.file.string() + ": " + title(node);
  }
};

/// The first few of some names, and how many more there are.
std::string few_gltf_titles(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 12;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i)
    list += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kShown) list += " and " + std::to_string(names.size() - kShown) + " more";
  return list;
}

/// "wagon" of "wagon.001": Blender tells copies apart by a dot and three digits or more.
std::string without_copy_number(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos || name.size() - dot < 4) return name;
  const bool is_number =
      std::all_of(name.begin() + static_cast<std::ptrdiff_t>(dot) + 1, name.end(),
                  [](unsigned char c) { return std::isdigit(c) != 0; });
  return is_number ? name.substr(0, dot) : name;
}

bool begins_with_port(const std::string& name) {
  constexpr std::string_view kPort = "port";
  return name.size() >= kPort.size() &&
         std::equal(kPort.begin(), kPort.end(), name.begin(),
                    [](char a, unsigned char b) { return a == std::tolower(b); });
}

/// Name of the port that a node of this name is; absent for other names.
std::optional<std::string> port_name_of_node(const std::string& name) {
  if (!begins_with_port(name)) return std::nullopt;
  if (name.size() > 4 && std::isalpha(static_cast<unsigned char>(name[4])) != 0)
    return std::nullopt;
  const std::string whole = without_copy_number(name);
  const std::size_t begin = whole.find_first_not_of("._- ", 4);
  return begin == std::string::npos ? "port" : whole.substr(begin);
}

bool is_empty_node(const SourceScene& scene, int i) {
  const json& node = scene.document["nodes"][i];
  return !scene.model.nodes[i].mesh && !node.contains("camera") &&
         !(node.contains("extensions") && node["extensions"].contains("KHR_lights_punctual"));
}

bool is_port_node(const SourceScene& scene, int i) {
  return scene.model.nodes[i].in_scene && port_name_of_node(scene.model.nodes[i].name) &&
         is_empty_node(scene, i);
}

/// The node above, where it is shown; -1 otherwise.
int shown_parent(const SourceScene& scene, int i) {
  const auto& parent = scene.model.nodes[i].parent;
  return parent && scene.model.nodes[*parent].in_scene ? static_cast<int>(*parent) : -1;
}

/// Ports of each node that is a part: each node, children first, hands its ports up until one has
/// a mesh.
std::vector<std::vector<int>> ports_of_nodes(const SourceScene& scene) {
  const std::size_t n = scene.model.nodes.size();
  std::vector<std::vector<int>> waiting(n), ports(n);
  std::vector<char> has_mesh(n, 0);
  const auto& order = scene.model.node_order;
  for (auto at = order.rbegin(); at != order.rend(); ++at) {
    const int i = static_cast<int>(*at);
    if (!scene.model.nodes[i].in_scene) continue;
    if (is_port_node(scene, i)) waiting[i].push_back(i);
    if (scene.model.nodes[i].mesh) has_mesh[i] = 1;
    const bool is_part = has_mesh[i] && !waiting[i].empty() && !is_port_node(scene, i);
    if (is_part) {
      ports[i] = std::move(waiting[i]);
      continue;
    }
    const int parent = shown_parent(scene, i);
    if (parent < 0 && !waiting[i].empty())
      throw Error("the port belongs to no part", scene.where(waiting[i].front()),
                  "ports below the node of a part, which has a mesh or holds one below (in "
                  "Blender: select the empty, then the part, and Ctrl+P)");
    if (parent < 0) continue;
    has_mesh[parent] |= has_mesh[i];
    waiting[parent].insert(waiting[parent].end(), waiting[i].begin(), waiting[i].end());
  }
  return ports;
}

std::string label_of_node(const SourceScene& scene, int node) {
  std::string label = without_copy_number(scene.model.nodes[node].name);
  if (label.empty())
    throw Error("the part has no name", scene.where(node), "a name, which is its label");
  return label;
}

/// Rigid pose, z up, and scale of a part's node.
void set_part_pose(const SourceScene& scene, FoundPart& part) {
  const Eigen::Affine3d& world = scene.world[part.node];
  const std::string where = scene.where(part.node);
  part.scale = world.linear().colwise().norm().transpose();
  if (!(part.scale.minCoeff() > 1e-9 * part.scale.maxCoeff()))
    throw Error("the part is scaled to nothing", where);
  const Eigen::Matrix3d axes = world.linear() * part.scale.cwiseInverse().asDiagonal();
  const Eigen::Matrix3d skewness = axes.transpose() * axes - Eigen::Matrix3d::Identity();
  const std::string way_out =
      "turned, moved and scaled along its own axes (in Blender: Object, Apply, Scale, of the part "
      "and of what it hangs on)";
  if (axes.determinant() < 0) throw Error("the part is mirrored", where, way_out);
  if (skewness.cwiseAbs().maxCoeff() > 1e-3) throw Error("the part is sheared", where, way_out);
  const Eigen::Matrix3d rotation = Eigen::Quaterniond(axes).normalized().toRotationMatrix();
  const Eigen::Matrix3d turn = z_up_of_gltf();
  part.pose.linear() = turn * rotation * turn.transpose();
  part.pose.translation() = turn * world.translation();
}

/// Frame of a port in the world, z up: x along the node's +Y axis, z along its -Z axis as far as it
/// is perpendicular to it.
Pose frame_of_port_node(const SourceScene& scene, int node) {
  const Eigen::Affine3d& world = scene.world[node];
  const Eigen::Matrix3d turn = z_up_of_gltf();
  const Eigen::Vector3d out = (turn * world.linear().col(1)).normalized();
  Eigen::Vector3d up = -(turn * world.linear().col(2)).normalized();
  up = (up - up.dot(out) * out).normalized();
  Pose frame = Pose::Identity();
  frame.linear() << out, up.cross(out), up;
  frame.translation() = turn * world.translation();
  if (!((frame.linear().transpose() * frame.linear() - Eigen::Matrix3d::Identity())
            .cwiseAbs()
            .maxCoeff() < 1e-6))
    throw Error("the port has no direction", scene.where(node), "axes that are not scaled to zero");
  return frame;
}

/// Parts in the order of their nodes.
std::vector<FoundPart> find_part_nodes(const SourceScene& scene) {
  const std::vector<std::vector<int>> ports = ports_of_nodes(scene);
  std::vector<FoundPart> parts;
  std::vector<int> owner(scene.model.nodes.size(), -1);
  for (std::size_t i = 0; i < ports.size(); ++i) {
    if (ports[i].empty()) continue;
    FoundPart part;
    part.node = static_cast<int>(i);
    part.label = label_of_node(scene, part.node);
    set_part_pose(scene, part);
    for (const int port : ports[i])
      part.ports.push_back({port, *port_name_of_node(scene.model.nodes[port].name),
                            frame_of_port_node(scene, port)});
    std::sort(part.ports.begin(), part.ports.end(), [](const FoundPort& a, const FoundPort& b) {
      return std::tie(a.name, a.node) < std::tie(b.name, b.node);
    });
    owner[i] = static_cast<int>(parts.size());
    parts.push_back(std::move(part));
  }
  for (const std::size_t node : scene.model.node_order) {
    if (!scene.model.nodes[node].in_scene) continue;
    const int i = static_cast<int>(node);
    const int parent = shown_parent(scene, i);
    if (owner[i] < 0 && parent >= 0) owner[i] = owner[parent];
    if (owner[i] >= 0) parts[owner[i]].nodes.push_back(i);
  }
  if (parts.empty())
    throw Error("the scene has no parts", scene.model.file.string(),
                "nodes with meshes that have empties below them whose names begin with \"port\" "
                "(\"port.in\", \"port.out\"), their arrows pointing out of the part");
  return parts;
}

void warn_of_others(const SourceScene& scene, const std::vector<FoundPart>& parts,
                    std::vector<std::string>& warnings) {
  std::vector<char> is_of_part(scene.model.nodes.size(), 0), is_part(is_of_part);
  for (const FoundPart& part : parts) {
    is_part[part.node] = 1;
    for (const int node : part.nodes) is_of_part[node] = 1;
  }
  std::vector<std::string> loose, near_ports;
  for (std::size_t i = 0; i < is_of_part.size(); ++i) {
    const gltf::Node& node = scene.model.nodes[i];
    const int index = static_cast<int>(i);
    if (!node.in_scene) continue;
    if (node.mesh && !is_of_part[i]) loose.push_back(scene.title(index));
    // A mesh that is named as a port, or an empty whose name goes on with a letter.
    const bool is_odd =
        port_name_of_node(node.name)
            ? node.mesh && !is_part[i]
            : begins_with_port(node.name) && node.children.empty() && is_empty_node(scene, index);
    if (is_odd) near_ports.push_back(scene.title(index));
  }
  const std::string file = scene.model.file.string() + ": ";
  if (!loose.empty())
    warnings.push_back(
        file + "left out, as they have meshes and belong to no part: " + few_gltf_titles(loose));
  if (!near_ports.empty())
    warnings.push_back(file +
                       "taken for no ports, as a port is an empty, and its name goes on "
                       "after \"port\" without a letter: " +
                       few_gltf_titles(near_ports));
  for (const json& used : scene.document.value("extensionsUsed", json::array())) {
    const std::string name = used.get<std::string>();
    const std::string loss = gltf::loss_without_extension(name);
    if (!loss.empty()) warnings.push_back(file + "extension " + name + ": " + loss);
  }
}

/// Reads the triangles of all nodes, and finds which are of which node: `read_gltf` puts the
/// meshes one after the other, parents before children, without primitives that are no surface.
void read_surfaces(const GltfScene& gathered, SourceScene& scene) {
  const std::string text = glb_bytes(*gathered.document, gathered.binary, gathered.file);
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  scene.mesh = read_gltf_bytes(bytes, scene.model.file).mesh;
  scene.mesh.V = (scene.mesh.V * z_up_of_gltf().transpose()).eval();
  scene.surfaces.resize(scene.model.nodes.size());
  int vertex = 0;
  int triangle = 0;
  for (const std::size_t i : scene.model.node_order) {
    const gltf::Node& node = scene.model.nodes[i];
    if (!node.in_scene || !node.mesh) continue;
    NodeSurface& surface = scene.surfaces[i];
    for (const gltf::Primitive& primitive : scene.model.meshes[*node.mesh].primitives) {
      if (primitive.mode < 4) continue;
      const int count =
          static_cast<int>(scene.model.accessors[primitive.attributes.at("POSITION")].count);
      surface.primitives.push_back({vertex, count});
      vertex += count;
    }
    surface.first_triangle = triangle;
    while (triangle < scene.mesh.triangle_count() && scene.mesh.F(triangle, 0) < vertex) ++triangle;
    surface.triangle_count = triangle - surface.first_triangle;
  }
}

double size_of_parts(const SourceScene& scene, const std::vector<FoundPart>& parts) {
  Eigen::AlignedBox3d box;
  for (const FoundPart& part : parts) {
    for (const FoundPort& port : part.ports) box.extend(port.world.translation());
    for (const int node : part.nodes)
      for (const PrimitiveVertices& range : scene.surfaces[node].primitives)
        for (int v = range.first; v < range.first + range.count; ++v)
          box.extend(Eigen::Vector3d(scene.mesh.V.row(v).transpose()));
  }
  return box.diagonal().norm();
}

/// Meshes and boxes of a part, in its coordinates.
void set_gltf_body(const SourceScene& scene, const FoundPart& part, PartType& type) {
  const Pose to_part = part.pose.inverse();
  int vertices = 0;
  int triangles = 0;
  for (const int node : part.nodes) {
    for (const PrimitiveVertices& range : scene.surfaces[node].primitives) vertices += range.count;
    triangles += scene.surfaces[node].triangle_count;
  }
  type.mesh.V.resize(vertices, 3);
  type.mesh.F.resize(triangles, 3);
  int v = 0;
  int f = 0;
  for (const int node : part.nodes) {
    const NodeSurface& surface = scene.surfaces[node];
    if (surface.primitives.empty()) continue;
    type.mesh.F.middleRows(f, surface.triangle_count) =
        scene.mesh.F.middleRows(surface.first_triangle, surface.triangle_count).array() +
        (v - surface.primitives.front().first);
    f += surface.triangle_count;
    for (const PrimitiveVertices& range : surface.primitives) {
      auto rows = type.mesh.V.middleRows(v, range.count);
      rows = (scene.mesh.V.middleRows(range.first, range.count) * to_part.linear().transpose())
                 .rowwise() +
             to_part.translation().transpose();
      v += range.count;
      const Eigen::Vector3d low = rows.colwise().minCoeff().transpose();
      const Eigen::Vector3d high = rows.colwise().maxCoeff().transpose();
      Box box;
      box.pose.translation() = (low + high) / 2;
      box.half = (high - low) / 2;
      type.boxes.push_back(box);
    }
  }
}

PartType make_gltf_type(const SourceScene& scene, const FoundPart& part) {
  PartType type;
  type.label = part.label;
  std::map<std::string, int> uses;
  for (const FoundPort& port : part.ports) {
    const int use = ++uses[port.name];
    const std::string name = use == 1 ? port.name : port.name + "-" + std::to_string(use);
    type.ports.push_back({name, part.pose.inverse() * port.world});
  }
  set_gltf_body(scene, part, type);
  return type;
}

std::string gltf_number_text(double x) {
  std::ostringstream text;
  text.precision(3);
  text << x;
  return text.str();
}

/// Orders the ports of a part as its label's first part has them.
void match_ports(const SourceScene& scene, const FoundPart& first, const PartType& type,
                 FoundPart& part) {
  const std::string where = scene.where(part.node);
  const std::string rule = "the same ports for all nodes of label '" + part.label +
                           "', or names that differ in more than a number at the end";
  if (part.ports.size() != first.ports.size())
    throw Error("has " + std::to_string(part.ports.size()) + " ports and " +
                    scene.title(first.node) + " has " + std::to_string(first.ports.size()),
                where, rule);
  std::vector<FoundPort> left = std::move(part.ports);
  part.ports.clear();
  for (std::size_t k = 0; k < first.ports.size(); ++k) {
    const std::string& name = first.ports[k].name;
    int nearest = -1;
    Pose off = Pose::Identity();
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (left[i].name != name) continue;
      const Pose here = type.ports[k].frame.inverse() * part.pose.inverse() * left[i].world;
      if (nearest >= 0 && here.translation().norm() >= off.translation().norm()) continue;
      nearest = static_cast<int>(i);
      off = here;
    }
    if (nearest < 0)
      throw Error("has no port '" + name + "', and " + scene.title(first.node) + " has one", where,
                  rule);
    const double distance = off.translation().norm();
    const double angle = Eigen::AngleAxisd(off.linear()).angle() / kDegree;
    if (distance > kSameOfScene * scene.size || angle > kSamePortDeg)
      throw Error("its port '" + name + "' is " + gltf_number_text(1e3 * distance) + " mm and " +
                      gltf_number_text(angle) + " degrees from where " + scene.title(first.node) +
                      " has it",
                  where, rule);
    part.ports.push_back(left[nearest]);
    left.erase(left.begin() + nearest);
  }
}

/// Materials of a part's primitives, as the document names them.
json materials_of(const SourceScene& scene, const FoundPart& part) {
  json materials = json::array();
  for (const int node : part.nodes) {
    const auto& mesh = scene.model.nodes[node].mesh;
    if (!mesh) continue;
    for (const json& primitive : scene.document["meshes"][*mesh]["primitives"])
      materials.push_back(primitive.value("material", json()));
  }
  return materials;
}

/// Whether a part looks as the first of its label: materials, number of vertices and boxes.
bool looks_as(const SourceScene& scene, const FoundPart& first, const PartType& type,
              const FoundPart& part) {
  if (materials_of(scene, first) != materials_of(scene, part)) return false;
  PartType other;
  set_gltf_body(scene, part, other);
  if (other.mesh.vertex_count() != type.mesh.vertex_count()) return false;
  if (other.boxes.size() != type.boxes.size()) return false;
  for (std::size_t i = 0; i < type.boxes.size(); ++i) {
    const Box &a = type.boxes[i], &b = other.boxes[i];
    if ((a.pose.translation() - b.pose.translation()).norm() + (a.half - b.half).norm() >
        2 * kSameOfScene * scene.size)
      return false;
  }
  return true;
}

/// Kinds of parts in the order of their first parts; every part gets its kind, and its ports the
/// order of that.
void find_gltf_types(const SourceScene& scene, std::vector<FoundPart>& parts, GltfParts& out) {
  std::map<std::string, int> first_of_label;
  std::vector<std::string> others;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    FoundPart& part = parts[i];
    const auto [known, is_new] = first_of_label.emplace(part.label, static_cast<int>(i));
    if (is_new) {
      part.type = static_cast<int>(out.read.set.types.size());
      out.read.set.types.push_back(make_gltf_type(scene, part));
      out.scene.types.push_back({part.label, part.nodes, part.scale});
      continue;
    }
    const FoundPart& first = parts[known->second];
    part.type = first.type;
    if ((part.scale - first.scale).norm() > kSameScale * first.scale.norm())
      throw Error("is of another scale than " + scene.title(first.node), scene.where(part.node),
                  "one scale for all nodes of label '" + part.label + "'");
    const PartType& type = out.read.set.types[part.type];
    match_ports(scene, first, type, part);
    if (!looks_as(scene, first, type, part))
      others.push_back(scene.title(part.node) + " as " + scene.title(first.node));
  }
  if (!others.empty())
    out.read.warnings.push_back(scene.model.file.string() +
                                ": meshes or materials differ within a label; variations show " +
                                few_gltf_titles(others));
}

/// Pairs of points that are within a distance of each other, in the order of their numbers.
std::vector<std::pair<int, int>> pairs_within(const std::vector<Eigen::Vector3d>& points,
                                              double distance) {
  std::vector<int> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::pair(points[a].x(), a) < std::pair(points[b].x(), b);
  });
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1;
         j < order.size() && points[order[j]].x() - points[order[i]].x() <= distance; ++j)
      if ((points[order[i]] - points[order[j]]).norm() <= distance)
        pairs.push_back(std::minmax(order[i], order[j]));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void require_parts_apart(const SourceScene& scene, const std::vector<FoundPart>& parts) {
  std::vector<Eigen::Vector3d> places;
  for (const FoundPart& part : parts) places.push_back(part.pose.translation());
  for (const auto& [i, j] : pairs_within(places, kSameOfScene * scene.size)) {
    const FoundPart &a = parts[i], &b = parts[j];
    if (a.type != b.type || (a.pose.linear() - b.pose.linear()).norm() > 1e-3) continue;
    throw Error("is at the place of " + scene.title(a.node), scene.where(b.node),
                "one part at a place");
  }
}

/// Ports of all parts, and which are joined.
class PortJoints {
 public:
  PortJoints(const SourceScene& scene, const std::vector<FoundPart>& parts) : scene_(scene) {
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (std::size_t k = 0; k < parts[i].ports.size(); ++k) {
        ports_.push_back(&parts[i].ports[k]);
        refs_.push_back({static_cast<int>(i), static_cast<int>(k)});
        titles_.push_back("port '" + parts[i].ports[k].name + "' (" +
                          scene.title(parts[i].ports[k].node) + ") of " +
                          scene.title(parts[i].node));
      }
    partner_.assign(ports_.size(), -1);
  }

  void join(std::vector<Connection>& connections, std::vector<std::string>& warnings) {
    std::vector<Eigen::Vector3d> places;
    for (const FoundPort* port : ports_) places.push_back(port->world.translation());
    const double most = std::min(kMostGltfJoint, kMostGltfJointOfScene * scene_.size);
    std::vector<std::pair<int, int>> touching, missed;
    for (const auto& [i, j] : pairs_within(places, kNearlyGltfJoint * most)) {
      if (refs_[i].part == refs_[j].part) continue;
      const bool is_near = (places[i] - places[j]).norm() <= most;
      const bool is_opposed = turn_deg(-axis(i, 0), axis(j, 0)) <= kMostOpposedDeg;
      if (is_near && is_opposed) {
        connect(i, j);
        connections.push_back({refs_[i], refs_[j]});
      } else if (is_near) {
        touching.emplace_back(i, j);
      } else if (is_opposed) {
        missed.emplace_back(i, j);
      }
    }
    warn(touching, true, "touch, but their arrows are not opposed: not joined", warnings);
    warn(missed, false,
         "are opposed and over " + gltf_number_text(1e3 * most) + " mm apart: not joined",
         warnings);
  }

 private:
  [[nodiscard]] Eigen::Vector3d axis(int port, int k) const {
    return ports_[port]->world.linear().col(k);
  }
  static double turn_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
  }

  void connect(int i, int j) {
    const std::string file = scene_.model.file.string() + ": ";
    for (const auto& [port, other] : {std::pair(i, j), std::pair(j, i)})
      if (partner_[port] >= 0)
        throw Error("three ports meet: " + titles_[port] + ", " + titles_[partner_[port]] +
                        " and " + titles_[other],
                    scene_.model.file.string(), "two at a place");
    const double roll = turn_deg(axis(i, 2), axis(j, 2));
    if (roll > kMostRollDeg)
      throw Error("meets " + titles_[i] + " rolled by " + gltf_number_text(roll) +
                      " degrees about its arrow",
                  file + titles_[j],
                  "arrows' roll that agrees: the local Y axes of the two empties (as Blender shows "
                  "them) in one direction");
    partner_[i] = j;
    partner_[j] = i;
  }

  /// Pairs where a port stays open; where both have to, the pair is one that was meant to be
  /// joined.
  void warn(const std::vector<std::pair<int, int>>& pairs, bool one_open_is_enough,
            const std::string& what, std::vector<std::string>& warnings) const {
    std::vector<std::string> names;
    for (const auto& [i, j] : pairs) {
      const int open = (partner_[i] < 0 ? 1 : 0) + (partner_[j] < 0 ? 1 : 0);
      if (open >= (one_open_is_enough ? 1 : 2)) names.push_back(titles_[i] + " and " + titles_[j]);
    }
    if (!names.empty())
      warnings.push_back(scene_.model.file.string() + ": ports that " + what + ": " +
                         few_gltf_titles(names));
  }

  const SourceScene& scene_;
  std::vector<const FoundPort*> ports_;
  std::vector<PortRef> refs_;
  std::vector<std::string> titles_;
  std::vector<int> partner_;
};

GltfParts read_parts_of(const std::vector<std::byte>& bytes, const std::filesystem::path& file,
                        bool other_files_allowed) {
  const gltf::Model model = gltf::parse_gltf(bytes, file, other_files_allowed);
  const json document = parse_json(gltf::split_container(bytes, file).json, file.string());
  GltfParts out;
  out.read.files.push_back(file);
  for (const gltf::Buffer& buffer : model.buffers)
    if (buffer.file) out.read.files.push_back(*buffer.file);
  SourceScene scene{model, document, gltf::world_transforms(model), {}, {}, 0};
  std::vector<FoundPart> parts = find_part_nodes(scene);
  warn_of_others(scene, parts, out.read.warnings);
  out.scene = gather_gltf(document, model, other_files_allowed, out.read);
  read_surfaces(out.scene, scene);
  scene.size = size_of_parts(scene, parts);
  find_gltf_types(scene, parts, out);
  require_parts_apart(scene, parts);
  Assembly assembly;
  assembly.name = file.stem().string();
  for (const FoundPart& part : parts) assembly.parts.push_back({part.type, part.pose});
  PortJoints(scene, parts).join(assembly.connections, out.read.warnings);
  out.read.set.models.push_back(std::move(assembly));
  require_valid(out.read.set);
  return out;
}

}  // namespace

GltfParts read_gltf_parts(const std::filesystem::path& file) {
  return read_parts_of(gltf::read_bytes(file), file, true);
}

GltfParts read_gltf_parts_bytes(const std::vector<std::byte>& bytes,
                                const std::filesystem::path& name) {
  return read_parts_of(bytes, name, false);
}

}  // namespace geoprior::assembly
