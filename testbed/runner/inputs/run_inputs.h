#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "testbed/runner/execute_request.h"
#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// A scene whose run references are replaced by the folders of the frames, or the artifacts, that
/// they mean.
struct ResolvedScene {
  std::shared_ptr<const OptionSet> options;
  std::vector<StoredFile> inputs;  ///< the reference and the input run's content_sha256
  bool stopped = false;            ///< Ctrl-C while an input was made or waited for
};

/// @throws Error  naming the experiments, when runs need each other in a circle
void require_no_circle(const Experiment& experiment, const std::vector<Topic>& topics);

/// How the finished run of an input is got, made first where there is none (`find_or_make_run`);
/// absent after Ctrl-C.
using InputMaker =
    std::function<std::optional<OpenedRun>(const Experiment& input, const ExecuteRequest& request)>;

/// Has the run of each reference made. The experiment must be in no circle.
ResolvedScene resolve_run_inputs(const Experiment& experiment, const CaseSpec& spec,
                                 const std::vector<Topic>& topics, const ExecuteRequest& request,
                                 const InputMaker& make);

/// The same of a run that is finished: each reference is the run whose `content_sha256` was
/// recorded, and none is made.
/// @param recorded  inputs of the finished run
/// @throws Error  naming a run that is no longer there
std::shared_ptr<const OptionSet> resolve_recorded_inputs(const Experiment& experiment,
                                                         const CaseSpec& spec,
                                                         const std::vector<Topic>& topics,
                                                         const std::vector<StoredFile>& recorded);

}  // namespace geoprior
