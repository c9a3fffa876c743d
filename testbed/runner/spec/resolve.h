#pragma once

#include <memory>
#include <string>
#include <vector>

#include "testbed/runner/spec/experiment.h"
#include "testbed/runner/spec/sweeps.h"
#include "testbed/runner/spec/tables.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {

/// What stands above the tables.
HeaderTable read_header(const TomlNode& root);

/// Reads [scene] of one case.
/// @param root  the experiment file of the case
/// @param json  gets the text of the options, defaults included
std::shared_ptr<const OptionSet> resolve_scene(const TomlNode& root, const Topic& topic,
                                               std::string& json);

/// Reads scene and variants of one case.
/// @param plain  the experiment file, without [[sweep]]
CaseSpec resolve_case(const SweptCase& swept, const TomlNode& plain, const Topic& topic,
                      const std::vector<std::string>& selected);

/// Names of the requested variants and of the references that they need; empty: all.
/// @param requested  empty: all, of a quick run those without `quick = false`
std::vector<std::string> select_variants(const TomlNode& root,
                                         const std::vector<std::string>& requested, bool quick);

}  // namespace geoprior
