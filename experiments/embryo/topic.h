#pragma once

#include <vector>

#include "testbed/topic.h"

namespace geoprior::embryo {

/// Tables of the topic.
std::vector<MethodEntry> methods();
std::vector<MetricGroup> metrics();
std::vector<DiagnosticEntry> diagnostics();
Topic make_topic();

}  // namespace geoprior::embryo
