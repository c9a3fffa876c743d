#include "experiments/skinning/weights/bone_contacts.h"

#include <algorithm>
#include <limits>
#include <string>

#include "core/disjoint_sets.h"
#include "core/error.h"
#include "core/parallel.h"

namespace geoprior::skinning {
namespace {

/// The nearest bones whose nearest point is `visible`.
template <class Visible>
BoneContact nearest_bones(const Eigen::Vector3d& p, const std::vector<Bone>& bones,
                          const Visible& visible) {
  std::vector<std::pair<double, int>> by_distance;
  for (int j = 0; j < std::ssize(bones); ++j)
    by_distance.emplace_back((bones[j].nearest(p) - p).norm(), j);
  std::sort(by_distance.begin(), by_distance.end());
  BoneContact contact;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [distance, bone] : by_distance) {
    if (distance > nearest * (1 + kEqualDistances)) break;
    if (!visible(bones[bone].nearest(p))) continue;
    if (contact.bones.empty()) nearest = distance;
    contact.bones.push_back(bone);
  }
  if (!contact.bones.empty()) contact.distance = nearest;
  return contact;
}

/// Vertices joined by common triangles.
DisjointSets components(const TriMesh& mesh) {
  DisjointSets sets(mesh.vertex_count());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 2; ++k) sets.join(mesh.F(t, k), mesh.F(t, k + 1));
  }
  return sets;
}

}  // namespace

std::vector<BoneContact> bone_contacts(const TriMesh& mesh, const std::vector<Bone>& bones) {
  const std::size_t n = mesh.vertex_count();
  std::vector<BoneContact> contacts(n);
  const InsideVisibility visibility(mesh);
  parallel_blocks(n, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto row = static_cast<int>(v);
      contacts[v] = nearest_bones(mesh.V.row(row), bones, [&](const Eigen::Vector3d& q) {
        return visibility.sees(row, q);
      });
    }
  });
  DisjointSets component = components(mesh);
  std::vector<bool> touched(n, false);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (!contacts[v].bones.empty()) touched[component.find(v)] = true;
  }
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (touched[component.find(v)]) continue;
    contacts[v] = nearest_bones(mesh.V.row(v), bones, [](const Eigen::Vector3d&) { return true; });
  }
  return contacts;
}

std::vector<Bone> require_bones(const TriMesh& mesh, const Skeleton& skeleton) {
  validate(skeleton);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (!mesh.V.row(v).allFinite())
      throw Error("position is not finite", "vertex " + std::to_string(v));
  }
  std::vector<Bone> bones = bones_of(skeleton);
  if (bones.empty())
    throw Error("no joint has a bone (a tail)", "skeleton", "at least one joint with a tail");
  return bones;
}

}  // namespace geoprior::skinning
