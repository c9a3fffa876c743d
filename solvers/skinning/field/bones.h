#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/inputs/rig.h"
#include "solvers/skinning/implicit_options.h"

namespace geoprior::skinning {

/// A bone that has skin of its own: one field is fitted to it.
struct FieldBone {
  int joint = 0;              ///< whose transform moves it
  int parent = -1;            ///< index of the nearest ancestor that is a FieldBone; -1: none
  bool has_children = false;  ///< another bone begins at its tail
  Eigen::Vector3d head = Eigen::Vector3d::Zero();
  Eigen::Vector3d tail = Eigen::Vector3d::Zero();  ///< equal to head for a joint without direction
  double reach = 0;   ///< largest distance of its vertices from the bone (m)
  double radius = 0;  ///< r: largest distance of its vertices from the bone (m), times scale
  std::vector<int> vertices;  ///< its part of the skin, sorted
};

/// Every vertex with the bone it belongs to (-1: none, because no joint with a field moves it).
struct BonePartition {
  std::vector<FieldBone> bones;  ///< parents before children
  std::vector<int> bone_of_vertex;
};

/// Splits the skin among the joints. A joint with fewer than `kMinBoneVertices` vertices makes no
/// field: its vertices go to the next joint that moves them. A joint without tail gets one from its
/// children, else from the centroid of its vertices. Fields of such joints only exist if there is
/// skin; a joint without skin gives its parent its tail.
BonePartition partition_bones(const RiggedMesh& rig, PartitionRule rule, double radius_scale);

inline constexpr int kMinBoneVertices = 12;

/// Fields at most: the bones that reach a block of vertices are listed in a fixed array, so that no
/// pass allocates.
inline constexpr int kMaxFieldBones = 512;

/// The point of the segment [a, b] nearest to p, as a fraction in [0, 1].
double segment_parameter(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b);

/// Distance of p from the segment [a, b].
double segment_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b);

}  // namespace geoprior::skinning
