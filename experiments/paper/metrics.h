#pragma once

#include <vector>

#include "testbed/topic.h"

namespace geoprior::paper {

/// The metric table of the topic.
std::vector<MetricEntry> metrics();

}  // namespace geoprior::paper
