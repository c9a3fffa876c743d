#pragma once

#include <map>
#include <vector>

#include "experiments/grammar/measures/recorded_state.h"

namespace geoprior::grammar {

/// m
double branch_length(const RecordedElement& branch);

/// Mean length of the branches of each level (m).
std::map<int, double> level_means_of(const RecordedState& rest);
/// That of the branch's level at rest; of a level that there was not, what the branch says.
double level_mean(const RecordedState& state, const RecordedElement& branch,
                  const std::map<int, double>& means_at_rest);

/// What is distributed in a tree, a value a branch.
struct BranchSamples {
  std::vector<double> lengths;  ///< over the mean of the level at rest
  std::vector<double> angles;   ///< to the direction of the branch that it hangs on (deg)
};
BranchSamples branch_samples(const RecordedState& state,
                             const std::map<int, double>& means_at_rest);

}  // namespace geoprior::grammar
