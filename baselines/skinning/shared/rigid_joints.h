#pragma once

#include <Eigen/Core>
#include <string_view>

#include "core/inputs/skeleton.h"

// What the methods that blend rotations ask of a pose.

namespace geoprior::skinning {

/// @throws Error  unless `pose` has one transform a joint, all finite; names the joint and `who`,
/// the method
void require_finite_pose(const Pose& pose, int joints, std::string_view who);

/// Rotation of a transform: the orthogonal factor of its polar decomposition, of determinant 1.
///
/// Rounding of a rotation is removed by steps of Newton's iteration for the polar factor (Higham
/// 1986), which square the error; anything else takes the full polar decomposition.
Eigen::Matrix3d rotation_of(const Eigen::Affine3d& transform);

}  // namespace geoprior::skinning
