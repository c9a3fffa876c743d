#pragma once

#include <vector>

#include "core/options.h"
#include "models/sound/resonators/grid.h"

namespace geoprior::sound {

/// What blocks vibrations.
struct CreaseOptions {
  double block = 20;
  double contrast = 1.25;
  double fold = 40;
  double gap = 0.01;
};
/// How far from a crease, across its ruling, the sheet beside it is looked at: twice the smoothing
/// of curvature (m).
inline constexpr double kBesideCrease = 8e-3;
void describe(OptionVisitor& v, CreaseOptions& options);

/// Cuts a sheet up at its creases: the number of each cell's part, -1 for creases and for cells
/// outside the sheet.
///
/// A crease is a ridge of |k|: at least `block`, and at least `contrast` times the mean of |k| at
/// the two places `kBesideCrease` from it, across its ruling; or it is `fold`, whatever lies
/// beside. So a sheet that is smoothly rolled up has none until its radius is less than 25 mm; with
/// the smoothing over 4 mm, 20 1/m is a fold of 11 degrees between two flat facets, 40 1/m one
/// of 23.
///
/// Creases that are found so have gaps, through which everything would be one part. A gap lets
/// nothing pass that is longer than twice its width: one of 10 mm stops bending waves of office
/// paper below 1 kHz. So a gap closes when it is narrower than `gap`, and than half the
/// widest place of the narrower of the parts that it joins, whatever the cell to which widths are
/// known: a strip is no neck of itself. Between a crease and the border of the sheet a gap counts
/// twice. Parts are the basins of the distance from the creases, flooded from the widest places
/// down, as in watersheds (Vincent and Soille 1991): two that meet become one unless the place
/// where they meet is such a gap.
std::vector<int> cut_at_creases(const SoundGrid& grid, const SheetField& field,
                                const CreaseOptions& options);

}  // namespace geoprior::sound
