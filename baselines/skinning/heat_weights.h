#pragma once

#include "core/options.h"
#include "core/rig.h"

namespace geoprior {

struct HeatWeightsOptions {
  double heat = 1.0;       ///< c in H = c / d^2
  int max_influences = 4;  ///< strongest kept and renormalised; 0 keeps all
};
void describe(OptionVisitor& v, HeatWeightsOptions& options);

/// Skin weights by bone heat equilibrium: (-Laplacian + H) w_j = H p_j (Baran and Popović 2007,
/// section 4). Joints without tail get no column entries.
SkinWeights heat_weights(const TriMesh& mesh, const Skeleton& skeleton,
                         const HeatWeightsOptions& options = {});

}  // namespace geoprior
