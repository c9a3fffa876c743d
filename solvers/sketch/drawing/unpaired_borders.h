#pragma once

#include <string>
#include <vector>

#include "solvers/sketch/drawing/curve_net.h"
#include "solvers/sketch/drawing/dense_matches.h"
#include "solvers/sketch/drawing/symmetric_pairs.h"

namespace geoprior::sketch {

/// Ids of the borders whose depth no symmetry tells: no pair ends on them and no match, they do not
/// run between two borders of which that is true, and bound no flat panel together with one. Rulings
/// alone say how such a border is shaped, but not how far away it lies.
std::vector<std::string> unpaired_borders(const CurveNet& net,
                                          const std::vector<SymmetricPair>& pairs,
                                          const std::vector<DenseMatch>& matches);

}  // namespace geoprior::sketch
