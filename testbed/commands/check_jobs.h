#pragma once

#include <string>
#include <vector>

#include "testbed/commands/commands.h"

namespace geoprior {

/// `check` of several experiments at once, each by this program in a process of its own: those that
/// took longest when they were blessed begin first. What is said of an experiment stands together,
/// in the order of `ids`. A process that crashes or is killed is an experiment that fails.
///
/// @return  the worst of the exit codes; `internal_error` where a process crashed or was killed
/// @throws Stopped  after Ctrl-C
int check_in_jobs(const CommandContext& context, const CheckRequest& request,
                  const std::vector<std::string>& ids);

}  // namespace geoprior
