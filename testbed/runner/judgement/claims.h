#pragma once

#include <optional>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// Decides every claim of the experiment on the cases of a run, and with its null in the place of
/// its variant what the claim is worth. A claim about a metric, variant, frame or phase that the
/// run does not have is an Error (it would otherwise hold silently); a null that has no value
/// leaves its claim undecided.
///
/// The null must fail by more than the metric's tolerance, with `reduce = "every"` in at least half
/// of the frames; where it is what the variant is compared with, the claim's own margin must be
/// more than the tolerance; beside a known shortfall it must be worse than the variant. A claim
/// over seeds holds, and its null fails, in at least nine of ten.
std::vector<ClaimRecord> decide_claims(const Experiment& experiment, const RunRecord& record);

/// Value over limit of a decided claim; absent without either, or for a limit of 0.
std::optional<double> slack(const ClaimRecord& claim);

/// Whether no null says that the claim is worth nothing: void and undecided claims are not sound.
bool is_sound(const ClaimRecord& claim);

}  // namespace geoprior
