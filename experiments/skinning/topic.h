#pragma once

#include "experiments/topic.h"

namespace geoprior {

/// Skinning: pose methods on a rigged character and a motion (thesis 3.1).
Topic skinning_topic();

/// The tables behind it: experiments/skinning/methods.cpp and experiments/skinning/metrics.cpp.
std::vector<MethodEntry> skinning_methods();
std::vector<MetricEntry> skinning_metrics();
std::vector<DiagnosticEntry> skinning_diagnostics();

}  // namespace geoprior
