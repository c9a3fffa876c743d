#pragma once

#include "tests/fuzz/scratch_home.h"

namespace geoprior::test {

// Frames as another program leaves them (docs/external-methods.md), in text where the format has
// one: mutations of words keep its grammar.

/// Three frames of water: a file of every kind that the layout has.
Files water_layout();

/// Three frames of a sheet that tears between two hands: every array that metrics read.
Files sheet_layout();

}  // namespace geoprior::test
