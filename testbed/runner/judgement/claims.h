#pragma once

#include <optional>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// Decides every claim of the experiment in every case of a run that has its sides, each with a
/// value, and with its null in the place of its variant what the claim is worth there. A claim
/// about a metric, variant, frame or phase that no case of the run has is an Error (it would
/// otherwise hold silently), and so is a seed without a value where others have one; a null that
/// has no value leaves its claim undecided.
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

/// The decisions of claims that are sound in none of their cases.
std::vector<ClaimRecord> unsound(const std::vector<ClaimRecord>& claims);

}  // namespace geoprior
