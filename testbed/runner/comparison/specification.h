#pragma once

#include <set>
#include <string>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {

/// A key that two specifications have other values of, or that one of them lacks.
struct KeyDifference {
  std::string key;     ///< dotted; tables of an array by name: "variant.implicit.options.step"
  std::string before;  ///< as JSON; "absent"
  std::string after;
};

/// The keys in which two resolved experiments differ, in the order of the first and then of the
/// second. [figure_view] and [check] are left out, as neither changes a number.
std::vector<KeyDifference> differing_keys(const TomlNode& before, const TomlNode& after);

/// The same of two tables, all of their keys.
std::vector<KeyDifference> differing_members(const TomlNode& before, const TomlNode& after);

/// A name of input files by which two runs read other bytes.
struct InputDifference {
  std::string name;
  std::set<std::string> before;  ///< SHA-256; none: absent
  std::set<std::string> after;
};

/// The input files that differ, sorted by name. One that only lies elsewhere is left out.
std::vector<InputDifference> differing_inputs(const std::vector<StoredFile>& before,
                                              const std::vector<StoredFile>& after);

}  // namespace geoprior
