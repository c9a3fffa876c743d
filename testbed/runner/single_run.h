#pragma once

#include <filesystem>
#include <vector>

#include "testbed/runner/execute_request.h"
#include "testbed/runner/inputs/run_inputs.h"
#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

struct ExecuteResult {
  std::filesystem::path folder;
  RunRecord record;
  bool stopped = false;       ///< Ctrl-C: the folder can be resumed
  bool was_finished = false;  ///< --resume of a finished run: nothing was done
};

/// The run of one experiment, as `execute` (execute.h) makes it, with what makes the runs that are
/// its inputs.
ExecuteResult run_once(const Experiment& experiment, const std::vector<Topic>& topics,
                       const ExecuteRequest& request, const InputMaker& make_input);

/// Whether a variant failed because of another program or its files, which may have been mended
/// since: `--resume` runs it again.
bool has_failed_outside(const RunRecord& record, const Topic& topic);

}  // namespace geoprior
