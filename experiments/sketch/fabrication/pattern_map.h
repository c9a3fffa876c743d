#pragma once

#include <string>

#include "experiments/sketch/pattern/sheet.h"
#include "models/sketch/pattern/pattern.h"

namespace geoprior::sketch {

/// Which point of the pattern is which vertex of the surface, a line each, as CSV with a header:
/// `piece,point,surface_vertex,x_mm,y_mm,sheet_x_mm,sheet_y_mm,name`.
///
/// x, y are the pattern's own coordinates; on the sheet the piece is turned and placed (right and
/// up from its lower left corner). A vertex on a seam occurs in several pieces. Numbers count from
/// 0; a point without a vertex has -1. The piece's name is in quotes. Refused pieces have no lines.
///
/// @param sheet   of this pattern
/// @throws Error  when a piece's list of vertices does not fit its points
std::string pattern_map_csv(const Pattern& pattern, const PatternSheet& sheet);

/// The pattern for other programs, as JSON: units, and of each piece its name, points (mm),
/// vertices of the surface, borders, edges with what they are sewn to, folds, notches, grain and
/// its place on the sheet; `"refused": true` where it has none. Names that are no UTF-8 get U+FFFD.
std::string pattern_json(const Pattern& pattern, const PatternSheet& sheet);

}  // namespace geoprior::sketch
