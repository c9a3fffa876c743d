#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"
#include "experiments/skinning/weights/bone_contacts.h"

namespace geoprior::skinning {

/// Parts of the skin by the bone nearest to them among those that are seen through the inside of
/// the mesh: the integral of every vertex' hat function over the skin of every bone (m^2), n x
/// bones.
///
/// What is equally near to two bones that meet, the outer side of a bent joint, is parted by the
/// bisector plane of the joint. Triangles that several bones share are cut into small ones. Where
/// no vertex of a triangle sees a bone the skin belongs to none; a vertex without triangles holds
/// to its bones with the mean area of the others.
///
/// @throws Error  when no skin belongs to any bone
Eigen::MatrixXd bone_skins(const TriMesh& mesh, const std::vector<Bone>& bones,
                           const std::vector<BoneContact>& contacts);

/// Local radius R of the limb at every vertex (m): the distance to the nearest bone, seen where one
/// is, averaged along the surface: (A + K) R = A d, with the conductivity of K (2 d)^2.
Eigen::VectorXd local_radii(const TriMesh& mesh, const std::vector<Bone>& bones,
                            const std::vector<BoneContact>& contacts);

}  // namespace geoprior::skinning
