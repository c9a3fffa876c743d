#pragma once

#include "solvers/paper/meshing/ruling_mesh.h"
#include "solvers/paper/sheet/structure.h"

namespace geoprior::paper {

/// Reads the pieces off the rulings and their mesh (thesis 3.2.1, Figure 3.7): fills
/// `structure.pieces`, `Ruling::piece`, `structure.border_points` and `mesh.piece`.
///
/// Rulings and border cut the pattern into cells. A cell between two rulings of one singular point
/// is a sector of a cone; a cell between two rulings from border to border that are nearly parallel
/// (`kParallelDegrees`) is a strip of a cylinder; neighbouring sectors of one apex are one cone,
/// neighbouring strips one cylinder. A hole may interrupt a side of a sector or strip, or lie in
/// it. Every other cell is flat: the triangles that singular points and rulings of several pieces
/// span, and the ground that nothing has bent. A bent piece keeps its id when most of its rulings
/// were in the piece of that id before.
void derive_pieces(PaperStructure& structure, const Pattern& pattern, RulingMesh& mesh);

/// Largest angle between the two rulings of a strip.
inline constexpr double kParallelDegrees = 25;

}  // namespace geoprior::paper
