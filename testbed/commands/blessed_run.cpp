#include "testbed/commands/blessed_run.h"

#include <unistd.h>

#include <optional>
#include <utility>

#include "core/error.h"
#include "testbed/catalogue.h"
#include "testbed/commands/console.h"
#include "testbed/commands/find.h"
#include "testbed/home.h"
#include "testbed/runner/inputs/made_run.h"
#include "testbed/runner/spec/spec.h"
#include "testbed/streams.h"

namespace geoprior {

Experiment load_without_clock(const CommandContext& context, const std::string& id_or_file,
                              bool quick) {
  LoadRequest load;
  load.quick = quick;
  Experiment experiment = load_experiment(experiment_file(id_or_file), context.topics, load);
  leave_out_times(experiment);
  return experiment;
}

std::filesystem::path file_of_clone(const Experiment& experiment) {
  return catalogued_file(experiment.id)
      .value_or(geoprior_home() / "experiments" / (experiment.id + ".toml"));
}

bool is_file_of_clone(const Experiment& experiment) {
  return std::filesystem::weakly_canonical(experiment.file) ==
         std::filesystem::weakly_canonical(file_of_clone(experiment));
}

std::string size_of(const Experiment& experiment) { return experiment.quick ? "quick" : "full"; }

BlessedRun run_without_clock(const CommandContext& context, Experiment experiment) {
  BlessedRun run;
  run.experiment = std::move(experiment);
  run.topic = &topic_of(run.experiment, context.topics);
  ExecuteRequest request;
  request.timing = false;
  request.only_declared = true;
  request.allow_commands = context.allow_commands;
  request.show_progress = isatty(STDERR_FILENO) == 1;
  const Error stopped("stopped", run.experiment.id, "the same command again");
  request.farewell = [&](const std::filesystem::path&) {
    say(std::string("error: ") + stopped.what());
  };
  const std::string size = run.experiment.quick ? " (quick)" : "";
  const std::optional<OpenedRun> made =
      find_or_make_run(run.experiment, context.topics, request,
                       tinted("running " + run.experiment.id + size, Tint::faint));
  if (!made) throw stopped;
  run.folder = made->folder();
  run.record = made->record();
  return run;
}

}  // namespace geoprior
