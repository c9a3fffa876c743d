#pragma once

#include <filesystem>
#include <string>

#include "testbed/commands/commands.h"
#include "testbed/runner/spec.h"

namespace geoprior {

/// A run that check and bless look at.
struct BlessedRun {
  Experiment experiment;  ///< without claims and studies about time
  const Topic* topic = nullptr;
  RunRecord record;
  std::filesystem::path folder;
};

/// The run of an experiment by this build: the one that is there, else a new one without timing.
/// Claims and studies about time are left out: no check depends on a clock.
/// @throws Error  when Ctrl-C stopped the run, and as load_experiment and execute do
BlessedRun run_without_clock(const CommandContext& context, const std::string& id, bool quick);

}  // namespace geoprior
