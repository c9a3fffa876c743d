#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "experiments/sketch/pattern/piece_verdict.h"
#include "experiments/sketch/pattern/sheet.h"
#include "models/sketch/pattern/pattern.h"

namespace geoprior::sketch {

/// Strain beyond which colours of the strain sheet do not change.
inline constexpr double kColouredStrain = 0.1;

/// Colour of a strain with its sign, as in figures 2.7 to 2.10 of the thesis: green where lengths
/// are kept, red where the surface is longer than the pattern, blue where it is shorter. Red, green
/// and blue in [0, 1].
Eigen::Vector3d strain_colour(double strain);

/// Triangles of one colour.
struct StrainPatch {
  Eigen::Vector3d colour{0, 0, 0};
  std::vector<std::array<Eigen::Vector2d, 3>> triangles;  ///< mm
};

/// The pieces of a pattern, refused ones too, coloured by their strain: to look at, not to cut by.
/// Right and up in millimetres from the lower left corner; pieces lie as in the pattern.
struct StrainSheet {
  Eigen::Vector2d size{0, 0};
  std::vector<StrainPatch> patches;  ///< by strain, ascending
  std::vector<SheetLine> outlines;   ///< of pieces, and of the colour bar
  std::vector<SheetLine> worst;      ///< crosses in circles at the worst places
  std::vector<SheetLine> added;      ///< cuts that are suggested
  std::vector<SheetText> texts;
};

/// @param verdicts  of each piece
/// @param surface   n x 3, the points that `surface_vertex` counts (m)
StrainSheet strain_sheet(const Pattern& pattern, const Eigen::MatrixX3d& surface,
                         const std::vector<PieceVerdict>& verdicts);

}  // namespace geoprior::sketch
