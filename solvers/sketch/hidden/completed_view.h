#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/hidden/seen_borders.h"

namespace geoprior::sketch {

/// A stretch of a border that nothing of the drawing shows.
struct GuessedStretch {
  std::string border;  ///< stroke that it continues; of a closing line its panel
  std::string from;    ///< "the parallel border 'top'", "an ellipse", …
  double length = 0;   ///< in the view (m)
};

/// A view whose borders are whole.
struct CompletedView {
  View view;
  std::vector<std::vector<DrawnPlace>> places;  ///< of each point of each stroke
  std::vector<GuessedStretch> guesses;
  /// Strokes of borders that a ruling joins and of which one is the parallel copy of the other.
  std::vector<std::array<int, 2>> copies;
  std::vector<std::string> open_ends;  ///< strokes that end where something covers them, as drawn
  double drawn_length = 0;             ///< of all borders in the view (m)
  double guessed_length = 0;

  /// Of a place on one of its strokes.
  [[nodiscard]] DrawnPlace place(int stroke, double at) const;
};

/// One sentence on what was guessed; empty when nothing was.
std::string completion_note(const CompletedView& completed);

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
