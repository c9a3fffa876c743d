#pragma once

#include <optional>
#include <string>
#include <vector>

#include "testbed/runner/execute_request.h"
#include "testbed/runner/inputs/run_inputs.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// Takes claims and studies about time out of an experiment: no check depends on a clock.
void leave_out_times(Experiment& experiment);

/// The experiment as it is run where nobody asks for times. That is not the run that `geoprior run`
/// makes: it has a hash of its own.
Experiment without_times(Experiment experiment);

/// The finished run of an experiment, with times or without: its frames and metrics are the same.
/// Where there is none it is made, or an interrupted one gone on with; where another program makes
/// it, it is waited for. So a run that several need, for itself or as input, is made once.
///
/// @param request       of a run that is made, `out` and `resume` excepted; without `timing` it is
///                      that of `without_times`
/// @param announcement  said before a run is made
/// @return              absent after Ctrl-C
/// @throws Error        as execute
std::optional<OpenedRun> find_or_make_run(const Experiment& experiment,
                                          const std::vector<Topic>& topics,
                                          const ExecuteRequest& request,
                                          const std::string& announcement);

/// Finds or makes the runs that are inputs of others, and their inputs likewise.
/// @param topics  must outlive what is returned
InputMaker input_maker(const std::vector<Topic>& topics);

}  // namespace geoprior
