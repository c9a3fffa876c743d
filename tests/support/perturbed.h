#pragma once

#include "tests/support/long_tests.h"

namespace geoprior {

/// How many perturbed good files a reader is tried on; suites that ask are named Long… .
inline int perturbed_files() { return test::at_length() ? 300 : 20; }

}  // namespace geoprior
