#pragma once

#include "tests/support/cost_listener.h"

namespace geoprior::test {

/// Runs all tests, as `RUN_ALL_TESTS`, in a child process that this one watches.
///
/// However the child ends (a signal from a fault, an abort or from outside, exit or _exit in the
/// middle of a test), this process names the test that it was in and returns a failure. It also
/// says what all of it cost. Under a debugger the tests run in this process.
///
/// @param usual_cost  as the listener's
/// @return  what `main` returns
int run_watched_tests(double usual_cost);

}  // namespace geoprior::test
