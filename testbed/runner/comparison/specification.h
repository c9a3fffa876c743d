#pragma once

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

/// The input files that two runs read other bytes of, sorted by name, with their SHA-256 in the
/// place of values. One that only lies elsewhere is left out.
std::vector<KeyDifference> differing_inputs(const std::vector<StoredFile>& before,
                                            const std::vector<StoredFile>& after);

}  // namespace geoprior
