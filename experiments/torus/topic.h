#pragma once

#include "testbed/topic.h"

namespace geoprior::torus {

/// "torus": the smooth flat torus, corrugated until it is isometric to a square (thesis 4).
Topic make_topic();

std::vector<MethodEntry> methods();
std::vector<MetricGroup> metrics();
std::vector<DiagnosticEntry> diagnostics();

}  // namespace geoprior::torus
