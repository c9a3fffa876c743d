#pragma once

#include <string>
#include <vector>

#include "core/options.h"
#include "experiments/sketch/fabrication/layer_style.h"
#include "experiments/sketch/fabrication/pattern_tiles.h"
#include "experiments/sketch/pattern/sheet.h"
#include "models/sketch/pattern/pattern.h"

namespace geoprior::sketch {

/// How a pattern is written for those who cut and sew it.
struct FabricationOptions {
  SheetOptions sheet;
  LayerStyle layers;
  TileOptions pages;
  bool cloth = false;
};

/// One description for parsing, validation and help.
void describe(OptionVisitor& v, FabricationOptions& options);

/// A file's name, without a folder, and its bytes.
struct FabricationFile {
  std::string name;
  std::string bytes;
};

/// All files of a pattern: `pattern.svg` and `pattern.dxf` (the whole sheet), `pattern.pdf` (the
/// sheet or its pages), `pattern.csv` and `pattern.json` (which vertex is which point); with pages,
/// `pattern-A1.svg` and so on for each.
///
/// @throws Error  naming what cannot be drawn, cut or tiled
std::vector<FabricationFile> fabrication_files(const Pattern& pattern,
                                               const FabricationOptions& options);

}  // namespace geoprior::sketch
