// Characters of several parts and skins, written as glTF from rigs that are made by formula.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/procedural.h"
#include "core/inputs/rig.h"
#include "tests/testbed/formats/gltf_samples.h"

namespace geoprior::skinning {

/// A mesh of the file, whose weights are on the joints of its skeleton.
struct MadePart {
  std::string name;
  TriMesh mesh;
  SkinWeights weights;
  int skin = 0;
};

/// Two bones along x, closed.
inline RiggedMesh made_tube() {
  CylinderOptions options;
  options.segments = 16;
  options.rings_per_half = 12;
  return two_bone_cylinder(options);
}

/// The tube without the two triangles of a patch of its side: four boundary edges.
inline RiggedMesh open_tube() {
  RiggedMesh rig = made_tube();
  const int first = 5 * 2 * 16;  // beyond the fan at the end, in a ring of the lower bone
  TriMesh& mesh = rig.mesh;
  const Eigen::MatrixX3i rest = mesh.F.bottomRows(mesh.F.rows() - first - 2);
  mesh.F.middleRows(first, rest.rows()) = rest;
  mesh.F.conservativeResize(mesh.F.rows() - 2, 3);
  return rig;
}

/// The rig's mesh, moved and shrunk about the origin.
inline MadePart part_of(const RiggedMesh& rig, const std::string& name, double scale = 1,
                        const Eigen::Vector3d& at = Eigen::Vector3d::Zero(), int skin = 0) {
  MadePart part{name, rig.mesh, rig.weights, skin};
  part.mesh.V = (scale * part.mesh.V).rowwise() + at.transpose();
  return part;
}

/// Skin k lists the joints rotated by k, so that the numbers of skins differ.
inline void add_skin(const Skeleton& skeleton, int k, test::GltfSample& s) {
  std::vector<float> bind;
  nlohmann::json list = nlohmann::json::array();
  for (int i = 0; i < skeleton.size(); ++i) {
    const int j = (i + k) % skeleton.size();
    const Eigen::Vector3f head = skeleton.joints[j].head.cast<float>();
    list.push_back(j);
    for (const float x : {1.F, 0.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 0.F, 1.F, 0.F, -head.x(),
                          -head.y(), -head.z(), 1.F})
      bind.push_back(x);
  }
  s.json["skins"].push_back({{"name", "skin-" + std::to_string(k)},
                             {"joints", list},
                             {"inverseBindMatrices", s.accessor<float>(bind, "MAT4", 16, 5126)}});
}

/// A mesh and its node.
inline void add_part(const MadePart& part, int joints, test::GltfSample& s) {
  std::vector<float> positions, weights;
  std::vector<std::uint32_t> corners;
  std::vector<std::uint8_t> entries;
  for (int v = 0; v < part.mesh.vertex_count(); ++v) {
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(part.mesh.V(v, k)));
    for (SkinWeights::InnerIterator it(part.weights, v); it; ++it) {
      weights.push_back(static_cast<float>(it.value()));
      entries.push_back(
          static_cast<std::uint8_t>((static_cast<int>(it.col()) - part.skin + joints) % joints));
    }
    weights.resize(4 * (v + 1UL));
    entries.resize(4 * (v + 1UL));
  }
  for (Eigen::Index f = 0; f < part.mesh.F.rows(); ++f)
    for (int k = 0; k < 3; ++k) corners.push_back(static_cast<std::uint32_t>(part.mesh.F(f, k)));
  nlohmann::json primitive;
  primitive["indices"] = s.accessor<std::uint32_t>(corners, "SCALAR", 1, 5125);
  primitive["attributes"] = {{"POSITION", s.accessor<float>(positions, "VEC3", 3, 5126)},
                             {"JOINTS_0", s.accessor<std::uint8_t>(entries, "VEC4", 4, 5121)},
                             {"WEIGHTS_0", s.accessor<float>(weights, "VEC4", 4, 5126)}};
  s.json["meshes"].push_back(
      {{"name", part.name}, {"primitives", nlohmann::json::array({primitive})}});
  s.json["nodes"].push_back(
      {{"name", part.name}, {"mesh", s.json["meshes"].size() - 1}, {"skin", part.skin}});
}

/// A clip that gives a property of a node the values of `from` and, one second later, `to`.
inline void add_clip(const std::string& path, const std::vector<float>& from,
                     const std::vector<float>& to, int node, test::GltfSample& s) {
  std::vector<float> keys = from;
  keys.insert(keys.end(), to.begin(), to.end());
  nlohmann::json animation = {{"name", "clip"}};
  animation["samplers"].push_back(
      {{"input", s.accessor<float>({0, 1}, "SCALAR", 1, 5126)},
       {"output", s.accessor<float>(keys, from.size() == 4 ? "VEC4" : "VEC3", from.size(), 5126)}});
  animation["channels"].push_back({{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}});
  s.json["animations"].push_back(animation);
}

/// Joints are nodes 0, 1, …, then come the parts.
inline test::GltfSample made_character(const Skeleton& skeleton, const std::vector<MadePart>& parts,
                                       int skins = 1) {
  test::GltfSample s;
  std::vector<std::size_t> roots;
  for (const Joint& joint : skeleton.joints) {
    Eigen::Vector3d at = joint.head;
    if (joint.parent >= 0) at -= skeleton.joints[joint.parent].head;
    s.json["nodes"].push_back({{"name", joint.name}, {"translation", {at.x(), at.y(), at.z()}}});
  }
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const int parent = skeleton.joints[j].parent;
    if (parent < 0) {
      roots.push_back(j);
    } else {
      s.json["nodes"][parent]["children"].push_back(j);
    }
  }
  for (int k = 0; k < skins; ++k) add_skin(skeleton, k, s);
  for (const MadePart& part : parts) {
    roots.push_back(s.json["nodes"].size());
    add_part(part, skeleton.size(), s);
  }
  s.json["scenes"] = nlohmann::json::array({{{"nodes", roots}}});
  return s;
}

}  // namespace geoprior::skinning
