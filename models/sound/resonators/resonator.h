#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/options.h"
#include "models/sound/resonators/grid.h"
#include "models/sound/resonators/parts.h"

namespace geoprior::sound {

/// The part of a sheet that swings freely after an event (thesis 3.2.3, Figure 3.18).
struct Resonator {
  std::vector<int> cells;    ///< ascending
  double area = 0;           ///< m^2
  double ruling_length = 0;  ///< l_r: mean length of its rulings (m)
  double free_border = 0;    ///< l_c: length of the paper's free border in it (m)
  double blocked_share = 0;  ///< of its border, by length: what is no free border
  double curvature = 0;      ///< mean of |k| between its creases (1/m)
};

/// Whether a place of the border is held: it is not free then.
using IsHeld = std::function<bool(const Eigen::Vector2d& place)>;

/// The parts of the sheet between creases (`cut_at_creases`) in which the seeds lie: the one that
/// holds most of them, and each that holds a fifth at least; and the creases that seeds lie on.
/// Where all do, the cells beside them stand for them. A crease, a strip of high curvature, is a
/// stiff constraint and else no part of a resonator.
///
/// Rulings are straight: l_r is the mean over the cells, each counted by |k|, of the length in the
/// resonator of the straight line through the cell along its ruling. Of a flat resonator, which has
/// no rulings, it is the root of the area. Its border with the rest of the sheet is a staircase of
/// cells, whose length counts pi/4, the mean over all directions.
///
/// @param parts    of the sheet, by cell
/// @throws Error  without seeds, or for one outside the sheet
Resonator find_resonator(const SoundGrid& grid, const SheetField& field,
                         const std::vector<int>& parts, const std::vector<int>& seeds,
                         const IsHeld& is_held);

}  // namespace geoprior::sound
