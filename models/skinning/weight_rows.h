#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/rig.h"
#include "models/skinning/bone_visibility.h"

namespace geoprior::skinning {

/// Weights from non-negative values, one row a vertex and one column a bone: the strongest
/// influences of each row, over their sum. The largest value left out is subtracted from those
/// kept, so that weights stay continuous where influences change places.
/// @param max_influences  0 keeps all
/// @throws Error  on a row without a positive value (names the vertex)
SkinWeights strongest_influences(const Eigen::MatrixXd& values, const std::vector<Bone>& bones,
                                 int joint_count, int max_influences);

}  // namespace geoprior::skinning
