#pragma once

#include "experiments/topic.h"

namespace geoprior {

/// "details": details on a surface that is deformed, which multiply and merge (thesis 2.2.2).
Topic details_topic();

std::vector<MethodEntry> details_methods();
std::vector<MetricEntry> details_metrics();
std::vector<DiagnosticEntry> details_diagnostics();

}  // namespace geoprior
