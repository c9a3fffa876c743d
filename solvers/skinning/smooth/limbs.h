#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/inputs/rig.h"
#include "solvers/skinning/field/bones.h"
#include "solvers/skinning/projection/skin_state.h"

namespace geoprior::skinning {

/// Length of a bone over the thickness of its skin, for a limb is longer than thick: a part of the
/// trunk up to `trunk`, a limb from `limb` on.
struct LimbRatios {
  float trunk;
  float limb;
};

/// How far the skin of each slot is that of a limb, in [0, 1]. A joint is one of limbs as far as
/// the less limb-like of its bones; between the ends of a bone it goes over smoothly.
std::vector<float> limb_shares(const RiggedMesh& rig, const BonePartition& partition,
                               const SkinState& state, LimbRatios ratios);

/// Distance of each vertex from its bone (m), at least 0.3 of the largest of that bone's; 0 without
/// one.
Eigen::VectorXd local_radii(const RiggedMesh& rig, const BonePartition& partition);

/// How far weights spread on a limb that is short for its thickness, as a phalanx: over less of its
/// radius, else two of its joints would bend as one.
enum class ShortLimbs { less, as_others };

/// Lengths over which the weights of each vertex spread, times a width (m): its local radius (the
/// mean of all without a bone), or less.
Eigen::VectorXd spread_lengths(const RiggedMesh& rig, const BonePartition& partition,
                               ShortLimbs short_limbs);

/// Means over one rings, `passes` times.
void smooth_values(std::vector<float>& values, const SkinState& state, int passes);

}  // namespace geoprior::skinning
