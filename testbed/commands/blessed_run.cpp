#include "testbed/commands/blessed_run.h"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "testbed/commands/catalogue.h"
#include "testbed/commands/console.h"
#include "testbed/runner/execute.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/run_folder.h"
#include "testbed/runner/sha256.h"

namespace fs = std::filesystem;

namespace geoprior {
namespace {

void drop_timing(Experiment& experiment) {
  std::erase_if(experiment.studies,
                [](const StudySpec& study) { return study.quantity.starts_with("timing:"); });
  std::erase_if(experiment.claims,
                [](const ClaimSpec& claim) { return claim.exempt == Exemption::timing; });
}

}  // namespace

Experiment load_without_clock(const CommandContext& context, const std::string& id_or_file,
                              bool quick) {
  LoadRequest load;
  load.quick = quick;
  Experiment experiment = load_experiment(experiment_file(id_or_file), context.topics, load);
  drop_timing(experiment);
  return experiment;
}

std::string size_of(const Experiment& experiment) { return experiment.quick ? "quick" : "full"; }

BlessedRun run_without_clock(const CommandContext& context, Experiment experiment) {
  BlessedRun run;
  run.experiment = std::move(experiment);
  run.topic = &topic_of(run.experiment, context.topics);
  std::optional<fs::path> folder = find_run(run.experiment);
  if (!folder) {
    // A run without times is not the run that `geoprior run` would make: it has a hash of its own.
    run.experiment.hash = sha256(run.experiment.hash + " without times");
    folder = find_run(run.experiment);
  }
  if (folder) {
    run.folder = *folder;
    run.record = OpenedRun(*folder).record();
    return run;
  }
  say(tinted("running " + run.experiment.id + (run.experiment.quick ? " (quick)" : ""),
             Tint::faint));
  ExecuteRequest request;
  request.timing = false;
  request.only_declared = true;
  request.resume = find_unfinished_run(run.experiment).has_value();
  request.show_progress = isatty(STDERR_FILENO) == 1;
  const Error stopped("stopped", run.experiment.id, "the same command again");
  request.farewell = [&](const fs::path&) { say(std::string("error: ") + stopped.what()); };
  ExecuteResult result = execute(run.experiment, context.topics, request);
  if (result.stopped) throw stopped;
  run.folder = result.folder;
  run.record = std::move(result.record);
  return run;
}

}  // namespace geoprior
