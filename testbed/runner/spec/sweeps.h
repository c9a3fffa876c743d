#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "testbed/runner/spec/tables.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {

/// Most cases of an experiment.
inline constexpr double kMostCases = 10000;

/// A case before its options are read: what it changes in the experiment file. Copies of the file
/// for all cases at once would take the square of the number of swept values.
struct SweptCase {
  std::string name = "default";
  std::map<std::string, std::string> swept;
  std::vector<std::string> variants;  ///< empty: all
  bool claims_only = false;
  std::vector<std::pair<std::string, TomlNode>> changes;  ///< dotted keys and values, in order
};

/// The keys of a [[sweep]] beside its values.
SweepTable read_sweep_table(const TomlNode& node);

/// The cases of the sweeps; `quick` uses `quick_values` where they are given.
/// @throws Error  naming the sweep with which there are more than `kMostCases`
std::vector<SweptCase> expand_sweeps(const TomlNode& root, bool quick);

/// The experiment file of one case, without its sweeps.
/// @param plain  the file, without [[sweep]]
TomlNode root_of(const SweptCase& swept, const TomlNode& plain);

}  // namespace geoprior
