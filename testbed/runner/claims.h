#pragma once

#include "testbed/runner/run_record.h"
#include "testbed/runner/spec.h"

namespace geoprior {

/// Decides every claim of the experiment on the cases of a run. A claim about a metric, variant,
/// frame or phase that the run does not have is an Error (it would otherwise hold silently).
std::vector<ClaimRecord> decide_claims(const Experiment& experiment, const RunRecord& record);

}  // namespace geoprior
