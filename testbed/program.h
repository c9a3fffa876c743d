#pragma once

#include <vector>

#include "testbed/topic.h"

namespace geoprior {

/// The whole command line on a set of topics (tests pass their own). Returns the exit code: 0 done,
/// 1 a check or claim fell short, 2 wrong use or bad input, 3 internal error.
int run_program(int argc, const char* const* argv, const std::vector<Topic>& topics);

}  // namespace geoprior
