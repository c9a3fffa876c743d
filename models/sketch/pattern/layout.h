#pragma once

#include <optional>

#include "models/sketch/pattern/pattern.h"

namespace geoprior::sketch {

struct ShelfOptions {
  double gap = 0.02;                 ///< between the boxes of pieces, and around none (m)
  std::optional<double> width = {};  ///< of the shelves (m); about a square when absent
};

/// Moves pieces, without turning them, onto shelves: from left to right while they fit into the
/// width, then a new shelf above the highest of the last; the highest pieces first, equal ones in
/// their order. A piece that is wider than the sheet has a shelf of its own. The lowest corner of
/// the whole is at 0, 0.
void lay_on_shelves(Pattern& pattern, const ShelfOptions& options);

}  // namespace geoprior::sketch
