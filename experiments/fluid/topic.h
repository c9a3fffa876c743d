#pragma once

#include <vector>

#include "testbed/topic.h"

namespace geoprior::fluid {

Topic make_topic();
std::vector<MethodEntry> methods();
std::vector<MetricGroup> metrics();
/// What the methods alone can know of a frame.
std::vector<DiagnosticEntry> diagnostics();

}  // namespace geoprior::fluid
