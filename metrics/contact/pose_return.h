#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/inputs/rig.h"

namespace geoprior {

/// Posed vertices carried back to rest, each by its joint of largest weight (the first of equals):
/// what is left when the skin moves rigidly with its bones is the rest pose.
/// @param posed  n x 3 (m)
Eigen::MatrixX3d in_bone_frame(const SkinWeights& weights, const Pose& pose,
                               const Eigen::MatrixX3d& posed);

/// How far skin is, in a pose, from where it was when the skeleton was in that pose before: 0 for
/// every method that does not depend on the way.
///
/// @param positions  one n x 3 matrix a frame (m)
/// @param poses      of the frames
/// @param radius     local radius of each vertex (m); vertices without one (NaN) are left out
/// @return           largest distance over the radius; absent when no pose comes twice
/// @throws Error     when the sizes differ
std::optional<double> pose_return(const std::vector<Eigen::MatrixX3d>& positions,
                                  const std::vector<Pose>& poses, const Eigen::VectorXd& radius);

}  // namespace geoprior
