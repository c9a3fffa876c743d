#pragma once

#include <memory>
#include <string>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"
#include "testbed/topic.h"

namespace geoprior {

/// The experiment's case of that name.
/// @throws Error  when a run has one that its experiment does not make
const CaseSpec& case_spec(const Experiment& experiment, const std::string& name);

/// The scene of a case as the run loaded it.
/// @throws Error  naming an input that is missing, or another than the one that was recorded
std::shared_ptr<Scene> load_recorded_scene(const Experiment& experiment, const CaseSpec& spec,
                                           const std::vector<Topic>& topics,
                                           const RunRecord& record);

/// The variant that the other is compared with; null when it has none, or it was left out.
const VariantRecord* reference_of(const CaseRecord& in, const VariantRecord& variant);

}  // namespace geoprior
