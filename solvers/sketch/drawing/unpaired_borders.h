#pragma once

#include <string>
#include <vector>

#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/drawing/curve_net.h"
#include "solvers/sketch/drawing/symmetric_pairs.h"

namespace geoprior::sketch {

/// Ids of the drawn borders whose depth no symmetry tells: no pair ends on them, they do not run
/// between two borders of which that is true, and bound no panel named flat together with one.
/// Rulings alone say how such a border is shaped, but not how far away it lies.
std::vector<std::string> unpaired_borders(const View& view, const CurveNet& net,
                                          const std::vector<SymmetricPair>& pairs);

}  // namespace geoprior::sketch
