#pragma once

#include <vector>

#include "experiments/topic.h"

namespace geoprior {

/// The metric table of the topic.
std::vector<MetricEntry> paper_metrics();

}  // namespace geoprior
