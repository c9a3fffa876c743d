#pragma once

#include "core/options.h"

namespace geoprior::details {

/// Which triangles of three details of the original the table holds (thesis 2.2.2: all of them).
struct TripletOptions {
  double radius = 3;
  bool all = false;
  bool interior_only = true;
  int cells = 128;
  int cell_capacity = 24;  ///< drawn at random among those met
};
void describe(OptionVisitor& v, TripletOptions& options);

}  // namespace geoprior::details
