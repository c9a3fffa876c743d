#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "testbed/figure_view.h"
#include "testbed/runner/spec/experiment.h"
#include "testbed/topic.h"

namespace geoprior {

struct LoadRequest {
  bool quick = false;
  std::vector<std::string> sets;      ///< "key=value" of --set
  std::vector<std::string> variants;  ///< of --variant; empty: all
  std::optional<int> threads;         ///< of --threads
};

/// Parses, applies [quick] and --set, expands sweeps, resolves options. Throws Error naming file,
/// line, key, allowed.
///
/// The identifier is `id`, else <folder>/<stem> for a file in experiments/<folder>/, else
/// <topic>/<stem>: always two names (testbed/runner/names.h). Selecting variants keeps the
/// references that they are compared with, and drops claims and studies about the others.
Experiment load_experiment(const std::filesystem::path& file, const std::vector<Topic>& topics,
                           const LoadRequest& request);

/// The experiment that a run was recorded with, from its resolved text.
///
/// @param source  names the text in messages
/// @param file    of the experiment: relative paths are tried beside it; it need not exist any more
/// @throws Error  as load_experiment: also where this program no longer knows what the text names
Experiment load_recorded_experiment(const std::string& resolved_toml, const std::string& source,
                                    const std::filesystem::path& file,
                                    const std::vector<Topic>& topics);

/// The [figure_view] of a resolved text (that of a run), to draw the run again.
FigureView figure_view_of(const std::string& resolved_toml, const std::string& source,
                          const std::vector<Topic>& topics);

}  // namespace geoprior
