#pragma once

#include "testbed/topic.h"

namespace geoprior::details {

/// "details": details on a surface that is deformed, which multiply and merge (thesis 2.2.2).
Topic make_topic();

std::vector<MethodEntry> methods();
std::vector<MetricGroup> metrics();
std::vector<DiagnosticEntry> diagnostics();

}  // namespace geoprior::details
