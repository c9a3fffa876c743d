#pragma once

#include "solvers/paper/hybrid_options.h"
#include "solvers/paper/meshing/ruling_editor.h"
#include "solvers/paper/shell/bending_guide.h"

namespace geoprior::paper {

/// Lays the rulings of the structure by the bending that the sheet wants.
///
/// A line of the pattern can stay straight where the sheet does not bend along it: with T the mean
/// of S S over its length and r its direction, r'T r / tr T is 0 where S r = 0 all along. Rulings
/// from border to border turn to where it is least, by `tracking_rate_deg` a frame at most; those
/// for which it stays above sin^2 of `follow_angle_deg` for some frames go. Then new lines are
/// laid: beside those that are there, and from where the sheet is bent most to both sides, each
/// near to the direction of the one beside, as long as none crosses another and none is nearer to
/// one than the bending asks for (a fold of `refine_angle_deg` a line, `seeding_distance` at most).
///
/// Lines that end in singular points are left alone. Returns true when anything changed.
/// @param frames  since the last call
bool follow_bending(const BendingField& field, const HybridOptions& options, RulingEditor& editor,
                    int& new_rulings, int frames = 1);

}  // namespace geoprior::paper
