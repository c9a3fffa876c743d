#pragma once

#include <vector>

#include "experiments/topic.h"

namespace geoprior {

Topic fluid_topic();
std::vector<MethodEntry> fluid_methods();
std::vector<MetricEntry> fluid_metrics();
/// What the methods alone can know of a frame.
std::vector<DiagnosticEntry> fluid_diagnostics();

}  // namespace geoprior
