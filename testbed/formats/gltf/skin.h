#pragma once

#include <vector>

#include "core/inputs/skeleton.h"
#include "testbed/formats/gltf/model.h"

namespace geoprior::gltf {

/// World transforms of the nodes at rest, in the order of the model.
std::vector<Eigen::Affine3d> world_transforms(const Model& model);

/// Skeleton and binding of a skin, and the transform that carries the mesh's own coordinates to
/// the rest pose.
struct SkinData {
  Skeleton skeleton;
  std::vector<int> joint_of_skin;  ///< for each entry of the skin's list, its joint in `skeleton`
  std::vector<std::size_t> node_of_joint;
  std::vector<Eigen::Affine3d> from_rest;
  Eigen::Affine3d to_rest = Eigen::Affine3d::Identity();
};
/// @throws Error  naming the joint of a singular or non-finite bind matrix
SkinData read_skin(const Model& model, std::size_t skin);

/// Adds the influences of a primitive's vertices as (vertex + first_vertex, joint, weight), each
/// vertex summing to 1.
/// @throws Error  naming the vertex: weights that sum to zero, negative or not finite, joints out
/// of range
void read_influences(const Model& model, const Primitive& primitive, const std::string& where,
                     const SkinData& skin, int vertex_count, int first_vertex,
                     std::vector<Eigen::Triplet<double>>& triplets, bool& renormalised);

}  // namespace geoprior::gltf
