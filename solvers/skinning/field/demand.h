#pragma once

#include "solvers/skinning/field/simd.h"

namespace geoprior::skinning {

/// What is asked of one vertex of the skin: a displacement u with `direction` . u = `amount`.
struct Demand {
  Float4 direction{};  ///< unit
  float amount = 0;    ///< metres
  float weight = 0;    ///< beside the others' and the smoothness; 0: nothing is asked
};

}  // namespace geoprior::skinning
