#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/options.h"
#include "models/paper/sound_grid.h"

namespace geoprior::paper {

/// What blocks vibrations.
struct ResonatorOptions {
  double block = 20;            ///< least curvature of a crease, which blocks vibrations (1/m)
  double contrast = 1.25;       ///< of a crease to the sheet beside it
  double fold = 40;             ///< curvature that blocks whatever lies beside it (1/m)
  double beside = 8e-3;         ///< where that is looked at, across the ruling (m)
  double crumpled_share = 0.5;  ///< of its border that is creases, from which on a resonator cracs
};
void describe(OptionVisitor& v, ResonatorOptions& options);

/// The part of a sheet that swings freely after an event (thesis 3.2.3, Figure 3.18).
struct Resonator {
  std::vector<int> cells;    ///< ascending
  double area = 0;           ///< m^2
  double ruling_length = 0;  ///< l_r: mean length of its rulings (m)
  double free_border = 0;    ///< l_c: length of the paper's free border in it (m)
  double blocked_share = 0;  ///< of its border, by length: what is no free border
  double curvature = 0;      ///< mean of |k| over it (1/m)
};

/// Whether a place of the border is held: it is not free then.
using IsHeld = std::function<bool(const Eigen::Vector2d& place)>;

/// Flood fill from `seeds` over cells that hold together, to creases, which are no part of it: a
/// strip of high curvature is a stiff constraint. Seeds are always part of it.
///
/// A crease is a ridge of |k|: at least `block`, and at least `contrast` times the mean of |k| at
/// the two places `beside` it, across its ruling; or it is `fold`, whatever lies beside. So a sheet
/// that is smoothly rolled up has none until its radius is less than 25 mm; with the smoothing over
/// 4 mm, 20 1/m is a fold of 11 degrees between two flat facets, 40 1/m one of 23.
///
/// Rulings are straight: l_r is the mean over the cells, each counted by |k|, of the length in the
/// resonator of the straight line through the cell along its ruling. Of a flat resonator, which has
/// no rulings, it is the root of the area. Its border with the rest of the sheet is a staircase of
/// cells, whose length counts pi/4, the mean over all directions.
///
/// @throws Error  without seeds, or for one outside the sheet
Resonator find_resonator(const SoundGrid& grid, const SheetField& field,
                         const std::vector<int>& seeds, const IsHeld& is_held,
                         const ResonatorOptions& options);

}  // namespace geoprior::paper
