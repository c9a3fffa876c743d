#pragma once

#include "core/frame.h"
#include "models/paper/shell/state.h"
#include "solvers/paper/meshing/ruling_mesh.h"
#include "solvers/paper/sheet/structure.h"

namespace geoprior::paper {

/// Puts the structure into a frame: parts "rulings" and "singular_points", cell arrays on
/// "surface", tables "pieces" and "singular_points".
void add_structure(const PaperStructure& structure, const RulingMesh& mesh, const ShellState& state,
                   Frame& frame);

}  // namespace geoprior::paper
