#pragma once

#include "testbed/topic.h"

namespace geoprior::skinning {

/// Skinning: pose methods on a rigged character and a motion (thesis 3.1).
Topic make_topic();

/// The tables behind it: experiments/skinning/methods.cpp and experiments/skinning/metrics.cpp.
std::vector<MethodEntry> methods();
std::vector<MetricGroup> metrics();
std::vector<DiagnosticEntry> diagnostics();

}  // namespace geoprior::skinning
