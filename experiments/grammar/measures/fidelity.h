#pragma once

#include <optional>
#include <set>
#include <span>
#include <vector>

#include "experiments/grammar/measures/asked.h"
#include "experiments/grammar/measures/recorded_state.h"

namespace geoprior::grammar {

/// How far a state is from what the user asks for (m): root mean square over the elements, each the
/// root mean square over its key points, of the distance from where they are asked to be. Elements
/// that were there at rest and still are, and have key points.
struct Deviation {
  double of_state = 0;
  double of_nothing = 0;  ///< the same of the object at rest
};
/// Absent without such elements.
std::optional<Deviation> deviation_of(const RecordedState& state, const RecordedState& rest,
                                      const AskedPlaces& asked);

/// The same of all that were there at rest, where only what keeps its constraints counts as served:
/// an element that breaks one, or is gone, counts as if it had stayed at rest, a broken one as it
/// is where that is farther. It is `of_nothing` for a state that does nothing, and for one that
/// breaks everything; elements that there were not at rest are not seen.
/// @param broken  numbers of elements
std::optional<Deviation> unserved_deviation_of(const RecordedState& state,
                                               const RecordedState& rest, const AskedPlaces& asked,
                                               const std::set<int>& broken);

/// Two states, key point by key point.
struct Difference {
  std::optional<double> largest;  ///< m: distance of two of the same element and number
  int unmatched = 0;              ///< elements that only one of the two has
};
Difference difference_of(const RecordedState& state, const RecordedState& other);

/// What became of the elements of one state in another.
struct ElementChanges {
  int before = 0;   ///< elements that there were
  int touched = 0;  ///< of these, those that are gone, or of which a key point or parameter is not
                    ///< the same, bit for bit
  int lost = 0;     ///< gone
  int added = 0;    ///< that there were not
};
ElementChanges element_changes(const RecordedState& state, const RecordedState& before);

/// Mean over the elements that had a size of what is left of it, 0 of those that are gone: how far
/// they kept apart by growing smaller. Absent where none has a parameter "size".
std::optional<double> kept_size(const RecordedState& state, const RecordedState& before);

/// Of these elements, those that are not the same bytes, or are gone.
int changed_among(std::span<const int> elements, const RecordedState& state,
                  const RecordedState& before);

/// What became of an element between two states.
struct KeptElement {
  double distance = 0;   ///< m: largest change of a distance between two of its key points
  double parameter = 0;  ///< largest difference of a parameter, in the parameter's unit
};
/// Absent when it is not there, or a number has become that of another type.
std::optional<KeptElement> kept_element(const RecordedState& now, const RecordedElement& before);

}  // namespace geoprior::grammar
