#pragma once

#include <vector>

#include "testbed/topic.h"

namespace geoprior::sketch {

/// Whole ways from a drawing to a pattern that differ from ours in one part: how the hull is made,
/// how pieces are laid flat.
std::vector<MethodEntry> compared_methods();

}  // namespace geoprior::sketch
