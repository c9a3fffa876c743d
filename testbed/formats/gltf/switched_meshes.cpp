#include "testbed/formats/gltf/switched_meshes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "core/error.h"
#include "testbed/formats/gltf/builder.h"

namespace geoprior {
namespace {

using gltf::GlbBuilder;
using nlohmann::json;

/// Colours of glTF are linear in light. Source: IEC 61966-2-1 (sRGB).
double linear_light(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

void require_piece(const GltfPiece& piece, std::ptrdiff_t materials, const std::string& where) {
  const TriMesh& mesh = piece.mesh;
  if (mesh.F.rows() == 0 || mesh.V.rows() == 0) throw Error("has an empty piece", where);
  if (mesh.F.minCoeff() < 0 || mesh.F.maxCoeff() >= mesh.V.rows())
    throw Error("a triangle's index is out of range", where);
  if (piece.normals.rows() != mesh.V.rows()) {
    throw Error("has " + std::to_string(piece.normals.rows()) + " normals", where,
                std::to_string(mesh.V.rows()) + ", one a vertex");
  }
  if (!mesh.V.allFinite() || !piece.normals.allFinite())
    throw Error("a position or normal is not finite", where);
  if (piece.material < 0 || piece.material >= materials)
    throw Error("there is no material " + std::to_string(piece.material), where);
}

void require_things(const std::vector<GltfSwitched>& things, std::ptrdiff_t materials,
                    const std::vector<double>& times_s, const std::string& name) {
  bool something = false;
  for (const GltfSwitched& thing : things) {
    const std::string where = name + ": '" + thing.name + "'";
    if (thing.frames.size() != times_s.size()) {
      throw Error("has " + std::to_string(thing.frames.size()) + " frames", where,
                  std::to_string(times_s.size()) + ", one a time");
    }
    for (const std::vector<GltfPiece>& pieces : thing.frames) {
      for (const GltfPiece& piece : pieces) require_piece(piece, materials, where);
      something = something || !pieces.empty();
    }
  }
  if (!something) throw Error("has no surface in any frame", name);
  gltf::require_times(times_s, name);
}

json material_of(const GltfMaterial& material) {
  json color = json::array();
  for (const double channel : material.color) color.push_back(linear_light(channel));
  color.push_back(1);
  return {{"name", material.name},
          {"doubleSided", true},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", color}, {"metallicFactor", 0}, {"roughnessFactor", 0.7}}}};
}

/// Grows the document thing by thing.
class SwitchedScene {
 public:
  SwitchedScene(const std::vector<GltfMaterial>& materials, const std::vector<double>& times_s)
      : times_s_(times_s) {
    for (const GltfMaterial& material : materials)
      document()["materials"].push_back(material_of(material));
  }

  void add(const GltfSwitched& thing) {
    const auto is_there = [](const std::vector<GltfPiece>& pieces) { return !pieces.empty(); };
    if (std::none_of(thing.frames.begin(), thing.frames.end(), is_there)) return;
    json node{{"name", thing.name}};
    if (times_s_.size() == 1) {
      node["mesh"] = add_mesh(thing.frames.front(), thing.name);
    } else {
      node["children"] = json::array();
      for (int i = 0; i < std::ssize(thing.frames); ++i) {
        if (!thing.frames[i].empty()) node["children"].push_back(add_frame(thing, i));
      }
    }
    roots_.push_back(add_node(node));
  }

  std::string glb(const std::string& name) {
    document()["scene"] = 0;
    document()["scenes"] = json::array({{{"name", name}, {"nodes", roots_}}});
    if (!nodes_of_frame_.empty()) add_animation(name);
    return builder_.glb(name);
  }

 private:
  json& document() { return builder_.document(); }

  int add_node(const json& node) {
    document()["nodes"].push_back(node);
    return static_cast<int>(document()["nodes"].size()) - 1;
  }

  int add_mesh(const std::vector<GltfPiece>& pieces, const std::string& name) {
    json mesh{{"name", name}};
    for (const GltfPiece& piece : pieces) {
      json primitive = builder_.primitive(piece.mesh);
      primitive["attributes"]["NORMAL"] = builder_.add_vectors(piece.normals);
      primitive["material"] = piece.material;
      mesh["primitives"].push_back(primitive);
    }
    document()["meshes"].push_back(mesh);
    return static_cast<int>(document()["meshes"].size()) - 1;
  }

  /// The node of one frame of a thing.
  int add_frame(const GltfSwitched& thing, int frame) {
    char number[16];
    std::snprintf(number, sizeof number, " %04d", frame);
    const std::string name = thing.name + number;
    json node{{"name", name}, {"mesh", add_mesh(thing.frames[frame], name)}};
    if (frame > 0) node["scale"] = {0, 0, 0};
    const int index = add_node(node);
    nodes_of_frame_[frame].push_back(index);
    return index;
  }

  /// One sampler a frame: 1 from its time to the next one's, 0 before and after. The first key of
  /// all is at the first time, so that every node has a value from there on; the last frame is seen
  /// as long as the one before it.
  int add_sampler(int frame, json& samplers) {
    std::vector<double> times;
    std::vector<float> scales;
    const auto add_key = [&](double time, float scale) {
      times.push_back(time);
      for (int k = 0; k < 3; ++k) scales.push_back(scale);
    };
    if (frame > 0) add_key(times_s_.front(), 0);
    add_key(times_s_[frame], 1);
    if (frame + 1 < std::ssize(times_s_)) {
      add_key(times_s_[frame + 1], 0);
    } else {
      add_key(2 * times_s_[frame] - times_s_[frame - 1], 1);
    }
    const int input = builder_.add_times(times);
    const int output = builder_.add(scales, "VEC3", 3);
    samplers.push_back({{"input", input}, {"output", output}, {"interpolation", "STEP"}});
    return static_cast<int>(samplers.size()) - 1;
  }

  void add_animation(const std::string& name) {
    json samplers = json::array(), channels = json::array();
    for (const auto& [frame, nodes] : nodes_of_frame_) {
      const int sampler = add_sampler(frame, samplers);
      for (const int node : nodes)
        channels.push_back({{"sampler", sampler}, {"target", {{"node", node}, {"path", "scale"}}}});
    }
    document()["animations"] =
        json::array({{{"name", name}, {"samplers", samplers}, {"channels", channels}}});
  }

  const std::vector<double>& times_s_;
  GlbBuilder builder_;
  std::vector<int> roots_;
  std::map<int, std::vector<int>> nodes_of_frame_;
};

}  // namespace

std::string switched_meshes_glb(const std::vector<GltfSwitched>& things,
                                const std::vector<GltfMaterial>& materials,
                                const std::vector<double>& times_s, const std::string& name) {
  require_things(things, std::ssize(materials), times_s, name);
  SwitchedScene scene(materials, times_s);
  for (const GltfSwitched& thing : things) scene.add(thing);
  return scene.glb(name);
}

}  // namespace geoprior
