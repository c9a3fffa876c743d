#pragma once

#include <vector>

#include "testbed/topic.h"

namespace geoprior::sound {

/// The sound of paper: an animated sheet is listened to (thesis 3.2.3).
Topic make_topic();

/// The methods of the topic: experiments/sound/methods.cpp.
std::vector<MethodEntry> methods();
/// What is measured of their sounds: experiments/sound/metrics.cpp.
std::vector<MetricGroup> metrics();
/// What they alone can know of a frame.
std::vector<DiagnosticEntry> diagnostics();

}  // namespace geoprior::sound
