#pragma once

#include <vector>

#include "testbed/runner/execute_request.h"
#include "testbed/runner/single_run.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// Runs an experiment: load each case's scene, run its variants, record, measure, time, decide
/// claims, assemble run.h5. Runs that are its inputs are made first. Pictures are the caller's:
/// they are drawn from the folder.
ExecuteResult execute(const Experiment& experiment, const std::vector<Topic>& topics,
                      const ExecuteRequest& request);

}  // namespace geoprior
