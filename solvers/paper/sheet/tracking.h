#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/paper/shell/state.h"
#include "solvers/paper/hybrid_options.h"
#include "solvers/paper/meshing/ruling_editor.h"
#include "solvers/paper/meshing/ruling_mesh.h"

namespace geoprior::paper {

/// Fold angle of the sheet at each ruling (rad, signed): mean of the dihedral angles of its edges,
/// weighted by length.
std::vector<double> fold_angles(const ShellState& state, const RulingMesh& mesh);

/// Puts rulings beside those of cones that fold by more than the refinement angle: halfway to the
/// next one of the cone, or as far as the one on the other side when there is none. Returns true
/// when any fitted.
bool refine_rulings(const std::vector<double>& folds, const HybridOptions& options,
                    RulingEditor& editor);

/// Counts for how long each ruling has been flat: folded by less than kappa_0 times the seeding
/// distance. A ruling next to one of its piece that refinement would put it beside counts as bent,
/// or it would come and go.
void count_flat_frames(const std::vector<double>& folds, const HybridOptions& options,
                       RulingEditor& editor);

/// Removes what has been flat for `flat_frames`: cylinders all of whose rulings have been, and
/// rulings of singular points, as long as no more than a right angle stays open beside them. Flat
/// rulings do no harm but cost: unless the sheet is `remeshed_anyway`, they wait until they are a
/// quarter of all. Returns true when any went.
bool retire_rulings(bool remeshed_anyway, const HybridOptions& options, RulingEditor& editor);

}  // namespace geoprior::paper
