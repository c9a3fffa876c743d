#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/inputs/rig.h"
#include "core/options.h"
#include "experiments/skinning/weights/bone_visibility.h"

namespace geoprior::skinning {

/// Weights from non-negative values, one row a vertex and one column a bone: the strongest
/// influences of each row, over their sum. The largest value left out is subtracted from those
/// kept, so that weights stay continuous where influences change places.
/// @param max_influences  0 keeps all
/// @throws Error  on a row without a positive value (names the vertex)
SkinWeights strongest_influences(const Eigen::MatrixXd& values, const std::vector<Bone>& bones,
                                 int joint_count, int max_influences);

/// The option `max_influences` of weights made by `strongest_influences`.
void describe_influence_limit(OptionVisitor& v, int& max_influences);
/// @param who  for the error
/// @throws Error  when it is negative
void require_influence_limit(int max_influences, const std::string& who);

}  // namespace geoprior::skinning
