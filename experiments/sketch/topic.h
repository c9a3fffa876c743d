#pragma once

#include "testbed/topic.h"

namespace geoprior::sketch {

/// "sketch": developable surfaces from annotated drawings (thesis 2.1).
Topic make_topic();

std::vector<MethodEntry> methods();
std::vector<MetricGroup> metrics();
std::vector<DiagnosticEntry> diagnostics();

}  // namespace geoprior::sketch
