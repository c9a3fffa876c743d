#pragma once

#include <filesystem>
#include <string>

#include "testbed/commands/commands.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// A run that check and bless look at.
struct BlessedRun {
  Experiment experiment;  ///< without claims and studies about time
  const Topic* topic = nullptr;
  RunRecord record;
  std::filesystem::path folder;
};

/// An experiment without its claims and studies about time: no check depends on a clock.
/// @throws Error  as load_experiment does
Experiment load_without_clock(const CommandContext& context, const std::string& id_or_file,
                              bool quick);

/// The file of the clone that has the experiment's identifier, or would have it.
std::filesystem::path file_of_clone(const Experiment& experiment);

/// Whether it is that file: only then are its reference values blessed. A file elsewhere may call
/// itself what it likes.
bool is_file_of_clone(const Experiment& experiment);

/// "full" or "quick": the set of reference values that the experiment's runs belong to.
std::string size_of(const Experiment& experiment);

/// The run of such an experiment by this build: the one that is there, else a new one without
/// timing.
/// @throws Error  when Ctrl-C stopped the run, and as execute does
BlessedRun run_without_clock(const CommandContext& context, Experiment experiment);

}  // namespace geoprior
