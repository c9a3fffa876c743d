#pragma once

#include <optional>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// A claim that is held by more says little of its value: it needs a reason.
inline constexpr double kMostTimesHeld = 5;

/// How many times better than its limit the value is: 2 for 0.5 <= 1, infinite for 0 <= 1. Absent
/// for an equality, a limit of 0, and sides below 0, which have no ratio.
std::optional<double> times_held(const ClaimSpec& claim, const ClaimRecord& decided);

/// Each claim is held by at most `kMostTimesHeld` in the case that is nearest to failing, or says
/// in `slack` why not. Times are not looked at, nor are cases that are not told apart.
/// @param claims  decided for the experiment
/// @throws Error  naming the first that does neither
void require_near_limits(const Experiment& experiment, const std::vector<ClaimRecord>& claims);

}  // namespace geoprior
