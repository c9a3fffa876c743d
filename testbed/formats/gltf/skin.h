#pragma once

#include <vector>

#include "core/inputs/skeleton.h"
#include "testbed/formats/gltf/model.h"

namespace geoprior::gltf {

/// World transforms of the nodes at rest, in the order of the model.
std::vector<Eigen::Affine3d> world_transforms(const Model& model);

/// How the meshes of one skin come to the skeleton.
struct SkinBinding {
  std::vector<int> joint_of_entry;  ///< for each entry of the skin's list, its joint
  /// For each joint of the skeleton: carries the mesh's own coordinates to the rest pose, as that
  /// joint is bound.
  std::vector<Eigen::Affine3d> to_rest;
  Eigen::Affine3d first_to_rest = Eigen::Affine3d::Identity();  ///< of the skin's topmost joint
  bool is_one_pose = true;  ///< `to_rest` is `first_to_rest` for all joints of the skin
};

/// Skeleton and binding of the skins that share it. The rest pose is the bind pose of the first,
/// placed by its topmost joint; joints that only later skins have stand where these are bound.
struct RigData {
  Skeleton skeleton;
  std::vector<std::size_t> node_of_joint;
  std::vector<Eigen::Affine3d> from_rest;
  std::vector<SkinBinding> skins;  ///< in the order that was given
};
/// @throws Error  naming the joint of a singular or non-finite bind matrix
RigData read_rig(const Model& model, const std::vector<std::size_t>& skins);

/// Whether a linear map takes space to a plane, a line or a point, or has entries that are not
/// finite; whatever its unit.
bool is_flat(const Eigen::Matrix3d& linear);

/// Notes joints that are bound with a scale that differs by direction, the one that differs most by
/// name: what turns on them is sheared.
void note_scaled_joints(const RigData& rig, std::vector<std::string>& notes);

/// Adds the influences of a primitive's vertices as (vertex + first_vertex, joint, weight), each
/// vertex summing to 1.
/// @throws Error  naming the vertex: weights that sum to zero, negative or not finite, joints out
/// of range
void read_influences(const Model& model, const Primitive& primitive, const std::string& where,
                     const SkinBinding& skin, int vertex_count, int first_vertex,
                     std::vector<Eigen::Triplet<double>>& triplets, bool& renormalised);

}  // namespace geoprior::gltf
