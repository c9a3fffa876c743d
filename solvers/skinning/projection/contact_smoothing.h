#pragma once

#include "solvers/skinning/projection/skin_state.h"

namespace geoprior::skinning {

/// Spreads the contact mark: `passes` Jacobi passes of beta <- mean of the one ring and
/// the vertex itself.
void diffuse_contact(SkinState& state, int passes);

/// `passes` Jacobi passes of v <- (1 - beta) v + beta (mean of the one ring), where beta > 0:
/// repairs the zigzag between vertices that stopped at a contact and their neighbours.
void smooth_contact(SkinState& state, int passes);

}  // namespace geoprior::skinning
