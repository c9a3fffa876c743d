#pragma once

#include <optional>

#include "experiments/grammar/measures/asked.h"
#include "experiments/grammar/measures/recorded_state.h"

namespace geoprior::grammar {

/// How much distributions of a tree's branches differ from those at rest (Kolmogorov and Smirnov's
/// distance); absent without branches.
struct TreeDistributions {
  std::optional<double> lengths;  ///< over the mean of the level at rest
  std::optional<double> angles;   ///< to the branch that each hangs on
};
TreeDistributions tree_distributions(const RecordedState& state, const RecordedState& rest);

/// How evenly the elements of a set fill it; absent without a set of items or grains.
struct SetDistribution {
  /// Standard deviation over mean of the distance to the nearest other element, of those whose size
  /// is at least a half: smaller ones are just growing, or shrinking.
  std::optional<double> spread;
  /// Largest distance of a place of the object from the nearest of the same elements, over the
  /// spacing, twice the mean radius. Places of a surface are its vertices; of a volume the middles
  /// of any two grains at rest within 1.5 spacings, where the map takes them.
  std::optional<double> hole;
};
SetDistribution set_distribution(const RecordedState& state, const RecordedState& rest,
                                 const AskedPlaces& asked);

}  // namespace geoprior::grammar
