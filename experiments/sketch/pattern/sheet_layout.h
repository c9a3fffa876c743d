#pragma once

#include <vector>

#include "experiments/sketch/pattern/piece_verdict.h"
#include "experiments/sketch/pattern/sheet.h"
#include "models/sketch/pattern/pattern.h"

namespace geoprior::sketch {

/// Lays out a pattern: cutting lines with allowance, sewing lines, folds, notches with numbers that
/// pair them, grain arrow and name of each piece, title and scale bar. Pieces stand in rows, the
/// highest first, the grain upwards.
///
/// @throws Error  naming the piece that cannot be drawn or cut (piece_border.h, seam_allowance.h)
PatternSheet pattern_sheet(const Pattern& pattern, const SheetOptions& options);

/// The sheet of a pattern that was judged: refused pieces are not drawn, the others have their
/// verdict below their name. A piece that cannot be drawn is refused likewise, with the reason in
/// its verdict.
///
/// @param force     draw pieces that are refused for their strain; their verdicts forget it
/// @param verdicts  of each piece (`judge_pieces`)
/// @throws Error    on a pattern that is no pattern (piece_border.h)
PatternSheet judged_sheet(const Pattern& pattern, const SheetOptions& options, bool force,
                          std::vector<PieceVerdict>& verdicts);

}  // namespace geoprior::sketch
