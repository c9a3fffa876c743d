#pragma once

#include "models/torus/input.h"

namespace geoprior::torus {

/// In place of a number N that is to be chosen.
constexpr int kChosenNumber = 0;

/// Chooses the numbers that are `kChosenNumber`, in their order: the smallest after which each
/// coefficient that the corrugations to come in this stage will have, or of the next stage after
/// the last one, is at least `margin` times what it would be if the corrugation had added exactly
/// rho pi^2 / |pi|^2 to the metric. Measured at drawn places, the same for every N; found by
/// doubling and halving, so that between two numbers of which the larger one fails a smaller one
/// that holds may be missed.
/// @throws Error  when no number up to 10^9 is large enough, or a coefficient of the corrugation
///                itself is not positive
void choose_numbers(TorusInput& input, double margin);

}  // namespace geoprior::torus
