#pragma once

#include "core/inputs/rig.h"
#include "core/options.h"
#include "experiments/skinning/weights/bone_visibility.h"
#include "experiments/skinning/weights/box_program.h"

namespace geoprior::skinning {

struct BoundedWeightsOptions {
  double length = 0.75;  ///< l
  int max_influences = 4;
};
void describe(OptionVisitor& v, BoundedWeightsOptions& options);

/// Skin weights that are bounded and smooth: for every bone the function of least biharmonic energy
/// about the skin nearest to it, among those between 0 and 1,
///
///   minimise  1/2 integral l^4 (laplacian w_b)^2  +  1/2 integral (w_b - chi_b)^2
///   subject to  0 <= w_b <= 1
///
/// normalised over the bones. chi_b is 1 on the skin nearest to bone b through the volume
/// (`bone_skins`) and l = length R in local radii. With linear elements the matrix of the program
/// (`solve_in_box`) is L A^-1 l^4 L + A.
///
/// Between heat weights and the bounded biharmonic weights of Jacobson et al. (2011): heat weights
/// are the same problem with the harmonic energy, where the bounds hold by themselves; theirs has
/// no second term and holds w_b = 1 on the bones in a tetrahedral volume, where here the skin alone
/// is discretised. As in theirs, the partition of unity is no constraint: of two bones it holds by
/// itself, where more meet the weights are normalised. The bounds make the weights local: across a
/// straight joint of a tube they are 0 and 1 from 3.34 l on (tan s + tanh s = 0, s = x / (sqrt(2)
/// l)), where the unbounded solution, 1 - exp(-s) cos(s) / 2, would overshoot by 3 percent.
///
/// @param mesh      n vertices; closed for nearness through the volume to mean anything, but any
///                  triangle mesh is accepted
/// @param skeleton  m joints (validated)
/// @return          n x m weights that pass `validate`
/// @throws Error    without any bone, for an invalid skeleton, a position that is not finite, a
///                  mesh without area, options out of range, or when a bone's weights cannot be
///                  solved for
/// Source: Jacobson, Baran, Popović and Sorkine 2011, section 3.
SkinWeights bounded_weights(const TriMesh& mesh, const Skeleton& skeleton,
                            const BoundedWeightsOptions& options = {});

/// The solution behind them, one column a bone, before it is normalised.
BoxSolution bounded_biharmonic(const TriMesh& mesh, const std::vector<Bone>& bones,
                               const BoundedWeightsOptions& options);

}  // namespace geoprior::skinning
