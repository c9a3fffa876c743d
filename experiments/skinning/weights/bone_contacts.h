#pragma once

#include <vector>

#include "core/mesh.h"
#include "experiments/skinning/weights/bone_visibility.h"

namespace geoprior::skinning {

/// The bones nearest to a vertex through the inside of the mesh: several when their distances are
/// equal, as at a joint where two bones end.
struct BoneContact {
  double distance = 0;     ///< m
  std::vector<int> bones;  ///< indices into the list of bones; none: the vertex sees no bone
};

/// Distances that differ by less than this share are equal.
inline constexpr double kEqualDistances = 1e-4;

/// Contact of every vertex. In a connected component none of whose vertices sees a bone (an eye, a
/// button), all vertices take the nearest bones, seen or not.
std::vector<BoneContact> bone_contacts(const TriMesh& mesh, const std::vector<Bone>& bones);

/// What weights by any rule are computed from.
/// @throws Error  for an invalid skeleton or one without any bone, or a position that is not finite
std::vector<Bone> require_bones(const TriMesh& mesh, const Skeleton& skeleton);

}  // namespace geoprior::skinning
