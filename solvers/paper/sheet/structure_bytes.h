#pragma once

#include "core/state_bytes.h"
#include "solvers/paper/sheet/structure.h"

namespace geoprior::paper {

/// Everything of a structure that does not follow from its rulings and singular points, for
/// checkpoints: these, and the kinds and ids of the pieces.
void write_structure(const PaperStructure& structure, StateWriter& out);
PaperStructure read_structure(StateReader& in);

}  // namespace geoprior::paper
