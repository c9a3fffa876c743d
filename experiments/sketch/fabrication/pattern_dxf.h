#pragma once

#include <string>

#include "experiments/sketch/pattern/sheet.h"

namespace geoprior::sketch {

/// A pattern as an AAMA-style DXF R12 file in ASCII, in millimetres.
///
/// One BLOCK is one piece, in its own coordinates with the grain upwards, and an INSERT places it
/// on the sheet. Layers: 1 cutting line (one closed POLYLINE) and the piece's system texts; 2 its
/// turn points and 3 its curve points; 4 notches (POINT on the cutting line); 7 grain (one LINE); 8
/// folds and the notches' ticks, which are drawn, not cut; 11 holes; 14 sewing lines; 15 other text
/// and the scale bar. Names are ASCII; other characters are written \U+XXXX.
///
/// The texts of the standards (ANSI/AAMA 292, ASTM D6673) are sold: this follows what pattern
/// programs publish of them, and no such program has read these files.
/// Source: Autodesk 1992, DXF reference of release 12; ASTM D6673's table of layers.
std::string dxf_drawing(const PatternSheet& sheet);

}  // namespace geoprior::sketch
