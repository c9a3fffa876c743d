#pragma once

#include <string>

#include "experiments/sketch/fabrication/layer_style.h"
#include "experiments/sketch/fabrication/pattern_tiles.h"
#include "experiments/sketch/pattern/sheet.h"

namespace geoprior::sketch {

/// One page of a pattern as an SVG file at true scale: user units are millimetres, y down.
///
/// Layers of Inkscape `cut`, `sew`, `fold`, `notch`, `grain`, `text` with one colour each; closed
/// lines end in Z. A line carries the number of its piece (`data-piece`, from 0) and its name
/// (`data-name`), a cutting or sewing line the number of its border (`data-border`, 0 the outer
/// one), a notch that of its pair (`data-notch`).
///
/// @throws Error  for a colour that is none (layer_style.h)
/// Source: SVG 1.1 (W3C 2011); Inkscape's layers.
std::string svg_page(const PatternSheet& sheet, const SheetPage& page, const LayerStyle& style);

}  // namespace geoprior::sketch
