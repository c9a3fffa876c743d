#pragma once

#include <Eigen/Core>
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
  bool force = false;
  bool add_seam = true;
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

/// The same of a pattern whose surface is known, piece by piece judged (piece_verdict.h): refused
/// pieces are in none of the files to cut by but in `pattern-refused.txt`, with the reason; where
/// all are refused, there are no files to cut by. `pattern-verdict.txt` has a line for each piece,
/// `pattern-strain.svg` and the last page of `pattern.pdf` all pieces coloured by their strain with
/// the cut that would ease the worst of those that are strained or refused.
///
/// @param surface  n x 3, the points that the pieces' `surface_vertex` count (m)
/// @throws Error   as `fabrication_files`, but for pieces that cannot be drawn
std::vector<FabricationFile> judged_fabrication_files(const Pattern& pattern,
                                                      const Eigen::MatrixX3d& surface,
                                                      const FabricationOptions& options);

}  // namespace geoprior::sketch
