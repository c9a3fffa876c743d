#pragma once

#include <vector>

#include "models/paper/shell/state.h"
#include "solvers/paper/sheet/structure.h"

namespace geoprior::paper {

/// Places that a strained sheet asks for: the triangles whose largest principal Green strain, in
/// modulus, is above `strain`, about each edges of half its own. None where they would be shorter
/// than `shortest` (m), or where a place as fine is there already.
std::vector<FinePlace> strained_places(const ShellState& state, double strain, double shortest,
                                       const std::vector<FinePlace>& there);

}  // namespace geoprior::paper
