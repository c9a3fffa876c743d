#pragma once

#include <string>
#include <vector>

#include "models/paper/sheet/pattern.h"
#include "models/paper/shell/state.h"
#include "solvers/paper/sheet/structure.h"

namespace geoprior::paper {

/// What the invariants say of a structure and its mesh; empty when all hold:
/// rulings of different pieces meet only at a common apex or the border; the mesh covers the
/// pattern exactly (areas agree to 1e-9, no triangle turned over or without area); every ruling is
/// a path of mesh edges; every singular point is a vertex.
std::vector<std::string> broken_invariants(const PaperStructure& structure, const Pattern& pattern,
                                           const ShellMesh& mesh);

}  // namespace geoprior::paper
