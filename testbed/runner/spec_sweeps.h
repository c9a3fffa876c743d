#pragma once

#include <map>
#include <string>
#include <vector>

#include "testbed/runner/toml_tree.h"

namespace geoprior {

/// A case before its options are read.
struct SweptCase {
  std::string name = "default";
  std::map<std::string, std::string> swept;
  std::vector<std::string> variants;  ///< empty: all
  bool claims_only = false;
  TomlNode root;
};

/// The cases of the sweeps; `quick` uses `quick_values` where they are given.
std::vector<SweptCase> expand_sweeps(const TomlNode& root, bool quick);

}  // namespace geoprior
