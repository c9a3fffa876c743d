#pragma once

#include "testbed/topic.h"

namespace geoprior::assembly {

/// "assembly": new assemblies from connected parts, by replaceable substructures (thesis 2.2.3).
Topic make_topic();

std::vector<MethodEntry> methods();
std::vector<MetricGroup> metrics();
std::vector<DiagnosticEntry> diagnostics();

}  // namespace geoprior::assembly
