#pragma once

#include "models/grammar/hierarchy/hierarchy.h"

namespace geoprior::grammar {

/// What a constrained optimisation of a whole object found, the bound that the grammar is measured
/// against.
struct OptimumResult {
  Hierarchy state;       ///< the better one of the two starts' results
  double deviation = 0;  ///< RMS over elements of the RMS over their keys (m)
  double gradient = 0;   ///< largest component of the projected gradient of half the squared
                         ///< deviation, of the variables as they are scaled
  int iterations = 0;    ///< of the start that was better
  int start = 0;         ///< 0: from the grammar's state; 1: from rest, re-targeted
};

}  // namespace geoprior::grammar
