#pragma once

#include <vector>

#include "solvers/sketch/drawing/hidden_borders.h"
#include "solvers/sketch/drawing/seen_borders.h"

namespace geoprior::sketch {

/// A drawing that is left as it is.
CompletedView as_drawn(const View& view);

/// The strokes of a drawing whose borders were put together: borders in the place of their first
/// strokes, other strokes as they were, one occlusion for each stretch that is guessed, and the
/// pairs that were added. Strokes in `out.copies` get their new numbers.
void put_strokes(const View& view, const std::vector<PartialBorder>& borders,
                 const std::vector<Stroke>& added_pairs, CompletedView& out);

/// A flat panel whose borders end to end leave two ends open gets a straight border between them.
/// @param snap  within which ends meet (m)
void close_panels(const std::vector<PartialBorder>& borders, double snap, CompletedView& out);

}  // namespace geoprior::sketch
