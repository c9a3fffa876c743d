#pragma once

#include <string>
#include <vector>

#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {

/// Refuses unknown top-level keys and tables written in the wrong way.
void require_known_tables(const TomlNode& root);

/// Sets a dotted key of the experiment file (scene.*, seed, threads, timing.*, figure_view.*,
/// variant.<name>.options.*).
void set_experiment_key(TomlNode& root, const std::string& key, const TomlNode& value);

/// Applies [quick] when asked, and removes it; then "key=value" texts of --set, of which "sweep=[]"
/// takes all sweeps out, and claims over seeds with them.
void apply_quick(TomlNode& root, bool quick);
void apply_sets(TomlNode& root, const std::vector<std::string>& sets);

/// The tables of an array of tables `[[key]]`; empty when absent.
std::vector<TomlNode> tables_of(const TomlNode& root, const std::string& key);

}  // namespace geoprior
