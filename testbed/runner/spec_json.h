#pragma once

#include <string>

#include "testbed/runner/spec.h"

namespace geoprior {

/// The resolved experiment as JSON: cases, variants, every option (spec.json of a run).
std::string spec_json(const Experiment& experiment);

}  // namespace geoprior
