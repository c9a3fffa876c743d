#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "testbed/runner/spec/experiment.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {

/// The resolved experiment as JSON: cases, variants, every option (spec.json of a run).
std::string spec_json(const Experiment& experiment);

/// The tree as JSON, keys in their order.
nlohmann::ordered_json json_of(const TomlNode& node);

}  // namespace geoprior
