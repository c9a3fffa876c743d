#pragma once

#include "core/frame.h"

namespace geoprior {

/// input + s (output - input): the output with its points, the numbers of its arrays and its tables
/// moved towards those of the input, wherever both have the same elements. Parts, arrays and tables
/// that the input does not have, or has in another topology, stay the output's; so do arrays whose
/// values are codes with names.
Frame blended_frame(const Frame& input, Frame output, double s);

}  // namespace geoprior
