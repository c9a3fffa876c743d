#include "testbed/runner/execute.h"

#include "testbed/runner/inputs/made_run.h"

namespace geoprior {

ExecuteResult execute(const Experiment& experiment, const std::vector<Topic>& topics,
                      const ExecuteRequest& request) {
  return run_once(experiment, topics, request, input_maker(topics));
}

}  // namespace geoprior
