#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/testbed/formats/gltf_samples.h"

namespace geoprior::test {

/// A glTF document as Blender's exporter writes it, under construction. What is given is in
/// Blender's axes (z up); what is written in glTF's (y up): (x, y, z) as (x, z, -y).
struct GltfToyScene {
  GltfSample sample;

  GltfToyScene() { sample.json["scene"] = 0; }

  nlohmann::json& node(int i) { return sample.json["nodes"][i]; }

  int add_material(const std::string& name, const Eigen::Vector3d& color) {
    sample.json["materials"].push_back({{"name", name},
                                        {"pbrMetallicRoughness",
                                         {{"baseColorFactor", {color.x(), color.y(), color.z(), 1}},
                                          {"metallicFactor", 0},
                                          {"roughnessFactor", .5}}}});
    return static_cast<int>(sample.json["materials"].size()) - 1;
  }

  /// A box about `center`; four vertices a side, so that its normals are sharp.
  int add_box(const std::string& name, const Eigen::Vector3d& center, const Eigen::Vector3d& half,
              int material) {
    std::vector<float> positions, normals;
    std::vector<std::uint16_t> corners;
    for (int side = 0; side < 6; ++side) {
      const int axis = side / 2;
      const double sign = side % 2 == 0 ? -1 : 1;
      for (const auto& [u, v] : std::array<std::pair<double, double>, 4>{
               {{-1, -sign}, {1, -sign}, {1, sign}, {-1, sign}}}) {
        Eigen::Vector3d normal = Eigen::Vector3d::Zero();
        normal[axis] = sign;
        Eigen::Vector3d corner = normal;
        corner[(axis + 1) % 3] = u;
        corner[(axis + 2) % 3] = v;
        append(center + half.cwiseProduct(corner), positions);
        append(normal, normals);
      }
      for (const int k : {0, 1, 2, 0, 2, 3})
        corners.push_back(static_cast<std::uint16_t>(4 * side + k));
    }
    const auto at = sample.accessor(positions, "VEC3", 3, 5126);
    sample.json["accessors"][at]["min"] = extreme(positions, -1);
    sample.json["accessors"][at]["max"] = extreme(positions, 1);
    const auto normal_at = sample.accessor(normals, "VEC3", 3, 5126);
    const auto corners_at = sample.accessor(corners, "SCALAR", 1, 5123);
    nlohmann::json primitive{{"attributes", {{"POSITION", at}, {"NORMAL", normal_at}}},
                             {"indices", corners_at},
                             {"material", material}};
    sample.json["meshes"].push_back(
        {{"name", name}, {"primitives", nlohmann::json::array({primitive})}});
    return static_cast<int>(sample.json["meshes"].size()) - 1;
  }

  /// A node below `parent` (-1: of the scene) with a mesh (-1: an empty).
  int add_node(const std::string& name, int parent, const Eigen::Isometry3d& pose, int mesh = -1) {
    const Eigen::Quaterniond q(pose.linear());
    const Eigen::Vector3d t = pose.translation();
    nlohmann::json added{{"name", name},
                         {"translation", {t.x(), t.z(), -t.y()}},
                         {"rotation", {q.x(), q.z(), -q.y(), q.w()}}};
    if (mesh >= 0) added["mesh"] = mesh;
    sample.json["nodes"].push_back(std::move(added));
    const int index = static_cast<int>(sample.json["nodes"].size()) - 1;
    if (parent < 0) {
      sample.json["scenes"][0]["nodes"].push_back(index);
    } else {
      node(parent)["children"].push_back(index);
    }
    return index;
  }
  int add_node(const std::string& name, int parent, const Eigen::Vector3d& place, int mesh = -1) {
    return add_node(name, parent, Eigen::Isometry3d(Eigen::Translation3d(place)), mesh);
  }

  /// An empty whose arrow (local z axis) points along `out`, its local y axis along `up`.
  int add_port(const std::string& name, int parent, const Eigen::Vector3d& place,
               const Eigen::Vector3d& out, const Eigen::Vector3d& up) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() << up.cross(out), up, out;
    pose.translation() = place;
    return add_node(name, parent, pose);
  }

  [[nodiscard]] std::vector<std::byte> bytes() const { return sample.bytes(); }

 private:
  static void append(const Eigen::Vector3d& x, std::vector<float>& values) {
    for (const double v : {x.x(), x.z(), -x.y()}) values.push_back(static_cast<float>(v));
  }
  /// Least (sign -1) or largest coordinates.
  static nlohmann::json extreme(const std::vector<float>& values, float sign) {
    std::array<float, 3> out{values[0], values[1], values[2]};
    for (std::size_t i = 0; i < values.size(); ++i)
      out[i % 3] = sign * std::max(sign * out[i % 3], sign * values[i]);
    return out;
  }
};

/// A wooden train of 0.6 m along x: an engine (at its back port "back") pulls three wagons
/// ("front", "back", "top"), which carry two crates and a barrel (each with a port "bottom"). The
/// engine has its boiler as a child; wagons share a mesh, and so do crates. Parts in the order of
/// their nodes: 0 engine, 1 to 3 wagons, 4 crate, 5 crate, 6 barrel; seven parts, six joints.
/// The train stands turned and away from the origin.
struct ToyTrain : GltfToyScene {
  std::vector<int> parts;  ///< nodes
  int ground = -1;         ///< a mesh without ports

  ToyTrain() {
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ();
    const int red = add_material("red paint", {.8, .1, .1});
    const int black = add_material("black", {.05, .05, .05});
    const int wood = add_material("wood", {.6, .4, .2});
    const int chassis = add_box("chassis", {0, 0, .03}, {.07, .03, .02}, red);
    const int boiler = add_box("boiler", {0, 0, 0}, {.04, .02, .02}, black);
    const int wagon = add_box("wagon", {0, 0, .03}, {.06, .03, .02}, wood);
    const int crate = add_box("crate", {0, 0, .02}, {.02, .02, .02}, wood);
    const int barrel = add_box("barrel", {0, 0, .03}, {.015, .015, .03}, red);
    const Eigen::Isometry3d track =
        Eigen::Translation3d(.3, .2, .1) * Eigen::AngleAxisd(.4, Eigen::Vector3d::UnitZ());
    const auto on_track = [&](double along, double height) {
      return track * Eigen::Translation3d(along, 0, height);
    };
    parts.push_back(add_node("engine", -1, on_track(0, 0), chassis));
    add_node("boiler", parts[0], {.02, 0, .07}, boiler);
    add_port("port.back", parts[0], {-.08, 0, .03}, -x, z);
    const char* kNumbers[] = {"", ".001", ".002"};
    for (int i = 0; i < 3; ++i) {
      const std::string number = kNumbers[i];
      const int node = add_node("wagon" + number, -1, on_track(-.15 - .14 * i, 0), wagon);
      add_port("port.top" + number, node, {0, 0, .05}, z, x);
      add_port("Port_front" + number, node, {.07, 0, .03}, x, z);
      add_port("port.back" + (i == 0 ? ".003" : number), node, {-.07, 0, .03}, -x, z);
      parts.push_back(node);
    }
    for (int i = 0; i < 3; ++i) {
      const std::string name = i == 2 ? "barrel" : std::string("crate") + kNumbers[i];
      const int node = add_node(name, -1, on_track(-.15 - .14 * i, .05), i == 2 ? barrel : crate);
      add_port("port.bottom" + std::string(kNumbers[i]), node, {0, 0, 0}, -z, x);
      parts.push_back(node);
    }
    ground = add_node("ground", -1, {0, 0, -.1}, add_box("ground", {0, 0, 0}, {2, 2, .01}, black));
  }
};

}  // namespace geoprior::test
