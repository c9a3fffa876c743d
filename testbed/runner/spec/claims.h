#pragma once

#include <map>
#include <string>
#include <vector>

#include "testbed/runner/spec/experiment.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {

/// What claims and studies may name.
struct KnownNames {
  std::vector<std::string> variants;  ///< those that run
  std::vector<std::string> dropped;   ///< those that --variant or a quick run leaves out
  std::vector<std::string> cases;     ///< of this version, and those that only the full one has
  std::vector<std::string> studies;
  std::map<std::string, std::string> references;  ///< of variants, by their name
};

std::vector<StudySpec> read_studies(const TomlNode& root, const Topic& topic,
                                    const KnownNames& names);
/// `tolerances` are those of the experiment, `studies` those that are decided.
std::vector<ClaimSpec> read_claims(const TomlNode& root, const Topic& topic,
                                   const KnownNames& names,
                                   const std::map<std::string, Tolerance>& tolerances,
                                   const std::vector<StudySpec>& studies);
std::map<std::string, Tolerance> read_tolerances(const TomlNode& root, const Topic& topic);
FigureView read_figure_view(const TomlNode& root, const Topic& topic);

}  // namespace geoprior
