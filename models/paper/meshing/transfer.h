#pragma once

#include <vector>

#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// Carries a state to another triangulation of the same pattern: positions and velocities linear on
/// the triangles of `from`, plastic curvature and damage area-weighted over the overlap of old and
/// new triangles, so that their integrals over the sheet stay (to round-off).
///
/// Where the sheet is cut open, a vertex of a lip comes from the lip on its side.
///
/// A vertex that both triangulations have keeps its position and velocity bit for bit.
/// @throws Error  when a vertex of `to` lies farther than 1e-6 of the pattern's width outside
/// `from`
ShellState transfer_state(const ShellState& from, const ShellMesh& to);

}  // namespace geoprior::paper
