#pragma once

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// Quantities across cases, with a 95 % interval (t for slopes, bootstrap for spreads and
/// matched quality, jackknife over the cases for pooled events; of times for ranges).
std::vector<StudyRecord> make_studies(const Experiment& experiment, const RunRecord& record);

}  // namespace geoprior
