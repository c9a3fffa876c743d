#pragma once

#include "solvers/skinning/projection/skin_state.h"

namespace geoprior::skinning {

/// Mean-value coordinates of every vertex in its one ring, in the plane normal to the FIELD's
/// gradient at rest: w_j = (tan(a_{j-1} / 2) + tan(a_j / 2)) / r_j, normalised. With the gradient
/// and not the mesh normal, relaxing the rest pose moves nothing. Vertices whose projected ring is
/// not star-shaped around them get zero weights and are never relaxed.
/// @param state  `position`: rest pose, `gradient`: of the field there; fills `ring_weight`
/// Source: Floater 2003; Vaillant et al. 2013, section 5.
void prepare_relaxation(SkinState& state);

/// Share of the move towards the weighted mean, as a function of the field error e = F - target.
enum class RelaxationLaw {
  paper,          ///< mu = max(0, 1 - (|e| - 1)^4)
  released_code,  ///< mu = (1 - (1 - min(1, 2 |e|))^2) / 2
};

/// One Jacobi pass of tangential relaxation of the active vertices:
/// v <- (1 - mu) v + mu sum_j w_j q_j, q_j = neighbours projected on the plane through v normal to
/// the field's gradient. It spreads the vertices that the projection bunches together.
void relax(SkinState& state, RelaxationLaw law);

}  // namespace geoprior::skinning
