#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/context.h"

namespace geoprior {

/// What a program from outside may use.
struct CommandLimits {
  double seconds = 3600;    ///< of the clock on the wall
  double megabytes = 4096;  ///< written below its working folder
};

/// How it ended, and what it took.
struct CommandEnd {
  std::string
      failure;  ///< why it did not end well, with the end of what it wrote on standard error
  bool stopped = false;  ///< we were asked to stop, and it was ended
  double wall_s = 0;
  double processor_s = 0;  ///< with its children that it waited for
  double peak_MB = 0;      ///< resident memory of the largest of its processes
};

/// Runs a program to its end, without a shell: arguments arrive as they are given. Its standard
/// input is empty, what it prints is thrown away but for the end of its standard error.
///
/// It leads a process group of its own. When it has ended, or has to end, everything that it
/// started is killed with it, also what left the group; that it dies with us, kill -9 included, is
/// as sure as Linux makes it (PR_SET_PDEATHSIG: the program itself, not what it started).
///
/// @param folder       its working folder
/// @param environment  "NAME=value", added to ours
/// @throws Error  when no process can be made
CommandEnd run_external_command(const std::vector<std::string>& command,
                                const std::filesystem::path& folder,
                                const std::vector<std::string>& environment,
                                const CommandLimits& limits, const RunContext& context);

}  // namespace geoprior
