#pragma once

#include <vector>

#include "experiments/topic.h"

namespace geoprior {

Topic fluid_topic();
std::vector<MethodEntry> fluid_methods();
std::vector<MetricEntry> fluid_metrics();

}  // namespace geoprior
