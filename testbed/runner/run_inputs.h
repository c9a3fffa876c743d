#pragma once

#include <memory>
#include <string>
#include <vector>

#include "testbed/runner/execute.h"
#include "testbed/runner/spec/spec.h"

namespace geoprior {

/// A text option "run:<experiment id>/<variant>" or "run:<experiment id>/<case>/<variant>"; the id
/// has two parts, "fluid/boat-wake". "#<file>" behind it means an artifact of the variant.
struct RunReference {
  std::string experiment_id;
  std::string case_name = "default";
  std::string variant;
  std::string artifact;  ///< empty: the frames
};

bool is_run_reference(const std::string& text);
/// @throws Error  when the text has not three or four parts, or no file name behind "#"
RunReference parse_run_reference(const std::string& text);

/// A scene whose run references are replaced by the folders of the frames, or the artifacts, that
/// they mean.
struct ResolvedScene {
  std::shared_ptr<const OptionSet> options;
  std::vector<StoredFile> inputs;  ///< the reference and the input run's content_sha256
  bool stopped = false;            ///< Ctrl-C while an input was made or waited for
};

/// @throws Error  naming the experiments, when runs need each other in a circle
void require_no_circle(const Experiment& experiment, const std::vector<Topic>& topics);

/// Finds the finished run of each reference, or makes it first; waits where another program is
/// making it. The experiment must be in no circle.
ResolvedScene resolve_run_inputs(const Experiment& experiment, const CaseSpec& spec,
                                 const std::vector<Topic>& topics, const ExecuteRequest& request);

/// The same of a run that is finished: each reference is the run whose `content_sha256` was
/// recorded, and none is made.
/// @param recorded  inputs of the finished run
/// @throws Error  naming a run that is no longer there
std::shared_ptr<const OptionSet> resolve_recorded_inputs(const Experiment& experiment,
                                                         const CaseSpec& spec,
                                                         const std::vector<Topic>& topics,
                                                         const std::vector<StoredFile>& recorded);

}  // namespace geoprior
