#pragma once

#include "testbed/topic.h"

namespace geoprior::paper {

/// Crumpled paper: simulations of a sheet that handles and obstacles deform (thesis 3.2).
Topic make_topic();

/// The methods of the topic: experiments/paper/methods.cpp.
std::vector<MethodEntry> methods();
/// What is measured of their frames: experiments/paper/metrics.cpp.
std::vector<MetricGroup> metrics();
/// What they alone can know of a frame.
std::vector<DiagnosticEntry> diagnostics();

}  // namespace geoprior::paper
