#include <nlohmann/json.hpp>
#include <string_view>

#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/commands/find.h"
#include "testbed/commands/outcome.h"
#include "testbed/commands/pictures.h"
#include "testbed/runner/judgement/grades.h"
#include "testbed/runner/judgement/measured_run.h"
#include "testbed/runner/process/stop.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

void say_names(std::string_view what, const std::vector<std::string>& names) {
  if (names.empty()) return;
  std::string line(what);
  for (const std::string& name : names) line += (&name == &names.front() ? "" : ", ") + name;
  say(line);
}

void say_changes(const MetricChanges& changes) {
  if (changes.added.empty() && changes.gone.empty() && changes.changed.empty()) {
    say("metrics  as they were, byte by byte");
  }
  say_names("new      ", changes.added);
  say_names("changed  ", changes.changed);
  say_names("gone     ", changes.gone);
}

nlohmann::ordered_json measured_json(const MeasuredRun& measured, const MetricChanges& changes,
                                     const fs::path& from, const fs::path& folder) {
  nlohmann::ordered_json json = outcome_json(measured.record, folder);
  json["measured_from"] = from.string();
  json["added"] = changes.added;
  json["changed"] = changes.changed;
  json["gone"] = changes.gone;
  return json;
}

}  // namespace

int measure_command(const CommandContext& context, const MeasureRequest& request) {
  install_stop_handler();
  const fs::path from = run_folder_of(request.run);
  const OpenedRun run(from);
  say("measuring " + from.string());
  std::optional<MeasuredRun> measured;
  {
    // Nothing is written yet.
    const LeaveAtOnce section([] { say("stopped: nothing was written"); });
    measured = measure_again(run, context.topics);
    grade_claims(measured->experiment, context.topics, from, measured->record);
  }
  const fs::path folder = write_measured_run(
      *measured, run, request.out ? std::optional<fs::path>(*request.out) : std::nullopt);
  Pictures pictures;
  if (request.pictures) pictures = make_pictures(folder, measured->experiment.view);
  const MetricChanges changes = metric_changes(run.record(), measured->record);
  say_changes(changes);
  say_claims(measured->record, false);
  for (const std::string& line : failures(measured->record)) say(tinted(line, Tint::bad));
  say("run      " + folder.string());
  if (context.json) print_json(measured_json(*measured, changes, from, folder));
  if (!pictures.error.empty()) {
    say("error: the run is complete, but its pictures are not: " + pictures.error);
    return wrong_use;
  }
  const bool whole = all_claims_hold(measured->record) && failures(measured->record).empty();
  return whole ? done : fell_short;
}

}  // namespace geoprior
