#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiments/runner/spec.h"
#include "experiments/runner/toml_tree.h"

namespace geoprior {

/// The steps of load_experiment, in their order.

/// Refuses unknown top-level keys and tables written in the wrong way.
void require_known_tables(const TomlNode& root);

/// Sets a dotted key of the experiment file (scene.*, seed, threads, timing.*, figure_view.*,
/// variant.<name>.options.*).
void set_experiment_key(TomlNode& root, const std::string& key, const TomlNode& value);

/// Applies [quick] when asked, and removes it; then "key=value" texts of --set.
void apply_quick(TomlNode& root, bool quick);
void apply_sets(TomlNode& root, const std::vector<std::string>& sets);

/// A case before its options are read.
struct SweptCase {
  std::string name = "default";
  std::map<std::string, std::string> swept;
  std::vector<std::string> variants;  ///< empty: all
  TomlNode root;
};

/// The cases of the sweeps; `quick` uses `quick_values` where they are given.
std::vector<SweptCase> expand_sweeps(const TomlNode& root, bool quick);

/// Reads scene and variants of one case.
CaseSpec resolve_case(const SweptCase& swept, const Topic& topic,
                      const std::vector<std::string>& selected);

/// Names of the selected variants and of the references that they need; empty: all.
std::vector<std::string> select_variants(const TomlNode& root,
                                         const std::vector<std::string>& requested);

/// What claims and studies may name.
struct KnownNames {
  std::vector<std::string> variants;  ///< those that run
  std::vector<std::string> dropped;   ///< those that --variant left out
  std::vector<std::string> cases;     ///< of this version, and those that only the full one has
  std::vector<std::string> studies;
};

std::vector<StudySpec> read_studies(const TomlNode& root, const Topic& topic,
                                    const KnownNames& names);
std::vector<ClaimSpec> read_claims(const TomlNode& root, const Topic& topic,
                                   const KnownNames& names);
std::map<std::string, Tolerance> read_tolerances(const TomlNode& root, const Topic& topic);
FigureView read_figure_view(const TomlNode& root, const Topic& topic);

/// The tables of an array of tables `[[key]]`; empty when absent.
std::vector<TomlNode> tables_of(const TomlNode& root, const std::string& key);

nlohmann::ordered_json json_of(const TomlNode& node);

}  // namespace geoprior
