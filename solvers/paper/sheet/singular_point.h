#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "solvers/paper/hybrid_options.h"
#include "solvers/paper/meshing/ruling_editor.h"

namespace geoprior::paper {

/// Puts a singular point into the structure and rulings around it (thesis 3.2.1: "the apex of
/// surrounding conical regions").
///
/// Rulings in conflict go (see `Conflict`). Lines from the point then lead to the singular points
/// and ruling ends that it sees: with the remaining rulings they bound flat triangles. What stays
/// open towards the border is divided by rulings into sectors of at most the fan angle: cones, as
/// far as the sheet bends them.
struct Conflict {
  std::vector<bool> crossed;        ///< by candidates, one flag a ruling
  std::vector<double> folds;        ///< fold angle of each ruling that the mesh has (rad)
  Eigen::Vector2d direction{1, 0};  ///< of the candidates
};

/// Which rulings go for a singular point at p: on each side along the candidates, the crossed ones
/// from the nearest on, as far as the reach of a cone, and until they have turned the sheet by
/// `flatten_angle_deg`, because the triangles that take their place are flat; and what is nearer
/// than the bounds allow. Rulings of the point itself stay.
std::vector<bool> rulings_in_conflict(const Eigen::Vector2d& p, std::optional<int> own,
                                      const Conflict& conflict, const HybridOptions& options,
                                      const RulingEditor& editor);

void add_singular_point(const Eigen::Vector2d& p, double time, const Conflict& conflict,
                        const HybridOptions& options, RulingEditor& editor);

/// Replaces the rulings in conflict with a singular point that is there already by rulings from it:
/// compression beside it widens its cones.
/// False when no ruling is in conflict with it.
bool widen_singular_point(int singular_point, const Conflict& conflict,
                          const HybridOptions& options, RulingEditor& editor);

/// Adds rulings from a singular point to the border wherever two of its rulings leave more than the
/// fan angle between them; returns how many.
int fill_fan(int singular_point, const HybridOptions& options, RulingEditor& editor);

}  // namespace geoprior::paper
