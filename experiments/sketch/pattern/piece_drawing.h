#pragma once

#include <vector>

#include "experiments/sketch/pattern/notches.h"
#include "experiments/sketch/pattern/sheet.h"

namespace geoprior::sketch {

/// All lines and texts of one piece, at the place (0, 0).
///
/// Names and numbers stand only where they touch no line; a name is shortened, set smaller and at
/// last left out when a piece is too narrow for it.
///
/// @param pattern  drawable (piece_border.h)
/// @param piece    index of the piece
/// @param notches  of the whole pattern
/// @param verdict  of the piece, below its name; none when empty
/// @throws Error   naming the piece whose borders cross or are degenerate (seam_allowance.h)
SheetPiece draw_piece(const Pattern& pattern, int piece, const std::vector<Notch>& notches,
                      const SheetOptions& options, const std::u32string& verdict = {});

}  // namespace geoprior::sketch
