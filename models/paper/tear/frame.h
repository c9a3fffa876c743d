#pragma once

#include "core/frame.h"
#include "models/paper/shell/state.h"
#include "models/paper/tear/growth.h"

namespace geoprior::paper {

/// Adds the part "tears" (lines, both lips of every tear; point arrays "pattern" [m] (2), "time"
/// [s], "tear" [1], "lip" [1]: 0 left, 1 right of the way of the tip), and the diagnostics
/// tear_length (m), tear_energy, tear_released (J), tear_steps, tears, tear_candidates (tested
/// since the start), tear_force (N) and tear_angle (deg) of the last growth; with the
/// option `detail` the parts of `add_lip_detail` too.
void add_tears(const TearGrowth& growth, const ShellState& state, Frame& frame);

}  // namespace geoprior::paper
