#pragma once

#include <vector>

#include "models/paper/tear/growth.h"
#include "solvers/paper/hybrid_options.h"
#include "solvers/paper/meshing/ruling_editor.h"

namespace geoprior::paper {

/// Places of a structure where a tear may start or go on (thesis 3.2.2): tips, corners at which the
/// sheet lies on the larger side, places where it is held, and junctions: where two pieces meet on
/// the border.
std::vector<TearCandidate> tear_candidates(const Sheet& sheet, const Tears& tears,
                                           const PaperStructure& structure);

/// Brings a structure in line with tears that have grown: rulings that a tear crosses end at its
/// lips, singular points that it passes go with theirs, and every tip is a singular point with
/// rulings about it, the apex of the cones that the lips open into.
/// @param editor  of the structure and the torn pattern
/// @return        singular points removed because a tear has passed them
int follow_tears(const Tears& tears, double time, const HybridOptions& options,
                 RulingEditor& editor);

}  // namespace geoprior::paper
