#include <unistd.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/commands/find.h"
#include "testbed/commands/outcome.h"
#include "testbed/commands/pictures.h"
#include "testbed/runner/execute.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/spec/spec.h"
#include "testbed/shell_word.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

/// The command that goes on with a stopped run, as it would be typed.
std::string resume_command(const CommandContext& context, const RunRequest& request,
                           const fs::path& folder) {
  std::string command = "geoprior run " + shell_word(request.experiment.id_or_file);
  for (const auto& name : request.experiment.load.variants)
    command += " --variant " + shell_word(name);
  for (const auto& set : request.experiment.load.sets) command += " --set " + shell_word(set);
  if (request.experiment.load.quick) command += " --quick";
  if (request.experiment.load.threads) {
    command += " --threads " + std::to_string(*request.experiment.load.threads);
  }
  if (!request.pictures) command += " --no-pictures";
  if (request.table) command += " --table";
  if (context.allow_commands) command += " --allow-commands";
  return command + " --out " + shell_word(folder.string()) + " --resume";
}

int report_stop(const CommandContext& context, const RunRequest& request, const fs::path& folder) {
  const std::string command = resume_command(context, request, folder);
  say("stopped; go on with:  " + command);
  if (context.json) {
    print_json({{"stopped", true}, {"run", folder.string()}, {"resume", command}});
  }
  return wrong_use;
}

/// Where the files are that methods left beside their frames (a pattern, sounds, a model): a line a
/// variant.
void say_artifacts(const ExecuteResult& result) {
  constexpr int kMost = 6;
  int lines = 0;
  for (const CaseRecord& of : result.record.cases) {
    for (const VariantRecord& variant : of.variants) {
      if (variant.artifacts.empty() || ++lines > kMost) continue;
      const fs::path folder = result.folder / variant.artifacts.front().name;
      say("files    " + folder.parent_path().string());
    }
  }
  if (lines > kMost) say("files    … and " + std::to_string(lines - kMost) + " more folders");
}

/// Claims and where to look; the table of all numbers, which summary.md has as well, when it is
/// asked for or there is no summary.md.
void say_outcome(const ExecuteResult& result, const Pictures& pictures, bool table) {
  const RunRecord& record = result.record;
  say();
  if (table) say_summary(record);
  if (table) say_studies(record);
  say_claims(record, table);
  if (!record.claims.empty()) say();
  for (const std::string& line : failures(record)) say(tinted(line, Tint::bad));
  const std::string claims = "claims   " + claim_count_text(record.claims);
  say(all_claims_hold(record) ? claims : tinted(claims, Tint::bad));
  say("numbers  " + pictures.summary.value_or(result.folder / "run.h5").string());
  if (pictures.figure) say("picture  " + pictures.figure->string());
  for (const auto& drawn : pictures.spectrograms) say("sound    " + drawn.string());
  say_artifacts(result);
  if (pictures.report) say("report   " + pictures.report->string());
}

}  // namespace

int run_command(const CommandContext& context, const RunRequest& request) {
  const fs::path file = experiment_file(request.experiment.id_or_file);
  const Experiment experiment = load_experiment(file, context.topics, request.experiment.load);
  install_stop_handler();
  ExecuteRequest execution;
  if (request.out) execution.out = *request.out;
  execution.resume = request.resume;
  execution.allow_commands = context.allow_commands;
  execution.grade = true;
  execution.show_progress = isatty(STDERR_FILENO) == 1;
  execution.farewell = [&](const fs::path& folder) { report_stop(context, request, folder); };
  say(tinted(experiment.id, Tint::strong) + (experiment.quick ? " (quick)" : "") + "  " +
      experiment.title);
  const ExecuteResult result = execute(experiment, context.topics, execution);
  if (result.stopped) return report_stop(context, request, result.folder);

  Pictures pictures;
  try {
    if (request.pictures) pictures = make_pictures(result.folder, experiment.view);
  } catch (const Stopped&) {
    return report_stop(context, request, result.folder);
  }
  say_told_files(result.record, topic_of(experiment, context.topics).told_files, result.folder,
                 !context.json);
  say_outcome(result, pictures, request.table || !pictures.summary);
  if (context.json) {
    nlohmann::ordered_json json = outcome_json(result.record, result.folder);
    json["stopped"] = false;
    if (pictures.figure) json["figure"] = pictures.figure->string();
    for (const auto& drawn : pictures.spectrograms) {
      json["spectrograms"].push_back(drawn.string());
    }
    if (pictures.report) json["report"] = pictures.report->string();
    print_json(json);
  }
  if (!pictures.error.empty()) {
    say("error: the run is complete, but its pictures are not: " + pictures.error);
    return wrong_use;
  }
  const bool whole = all_claims_hold(result.record) && failures(result.record).empty();
  return whole ? done : fell_short;
}

}  // namespace geoprior
