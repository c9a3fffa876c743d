#pragma once

#include <map>
#include <optional>
#include <vector>

#include "experiments/grammar/measures/asked.h"
#include "experiments/grammar/measures/recorded_state.h"

namespace geoprior::grammar {

/// Popping in a motion: what elements do from frame to frame beyond what the map asks for.
///
/// An element that there was not grows out of a point, one that is gone shrinks into one: it moves
/// by its extent. One that is not of the rest has no place there, so that nothing asks it to move;
/// a candidate that is not present at rest has one.
class PopMeter {
 public:
  /// Two frames that follow each other, in order: `asked` of each. Of several pairs the worst
  /// counts.
  void add(const RecordedState& before, const AskedPlaces& asked_before, const RecordedState& now,
           const AskedPlaces& asked_now);

  /// Largest unexplained displacement of a key point (m); absent before the first pair.
  [[nodiscard]] std::optional<double> largest() const { return largest_; }
  /// The same, each over the size of its element: the largest extent that it had in any frame, of
  /// one that has a parameter "size" its extent at full size.
  [[nodiscard]] std::optional<double> largest_over_size() const;

 private:
  struct Watched {
    double size = 0;  ///< m
    double pop = 0;   ///< m
  };
  void note(int element, double size, double pop);

  std::optional<double> largest_;
  std::map<int, Watched> watched_;
};

/// Diameter of what is seen of an element (m): that of its key points about their mean; where it
/// has one, twice its size times its radius.
double element_extent(const RecordedState& state, const RecordedElement& element);

/// Largest distance of a key point between two states (m), as for a motion that should have come
/// back: an element that only one of them has counts with its extent.
double return_gap(const RecordedState& start, const RecordedState& end);

}  // namespace geoprior::grammar
