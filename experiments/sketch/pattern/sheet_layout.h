#pragma once

#include "experiments/sketch/pattern/sheet.h"
#include "models/sketch/pattern/pattern.h"

namespace geoprior::sketch {

/// Lays out a pattern: cutting lines with allowance, sewing lines, folds, notches with numbers that
/// pair them, grain arrow and name of each piece, title and scale bar. Pieces stand in rows, the
/// highest first, the grain upwards.
///
/// @throws Error  naming the piece that cannot be drawn or cut (piece_border.h, seam_allowance.h)
PatternSheet pattern_sheet(const Pattern& pattern, const SheetOptions& options);

}  // namespace geoprior::sketch
