#include <algorithm>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/error.h"
#include "testbed/commands/blessed_run.h"
#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/commands/outcome.h"
#include "testbed/joined.h"
#include "testbed/runner/journal/content_hash.h"
#include "testbed/runner/judgement/claims.h"
#include "testbed/runner/judgement/grades.h"
#include "testbed/runner/judgement/measured_run.h"
#include "testbed/runner/process/build_info.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/reference/diff.h"
#include "testbed/runner/reference/headlines.h"
#include "testbed/runner/reference/slack.h"
#include "testbed/runner/run_folder.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {
namespace {

constexpr std::size_t kMostLines = 40;

void require_reason(const BlessRequest& request) {
  const bool blank = std::all_of(request.reason.begin(), request.reason.end(),
                                 [](unsigned char c) { return std::isspace(c) != 0; });
  if (!blank) return;
  throw Error("no reference value changes without a reason", "bless " + request.id,
              "--reason \"why the new values are right\"");
}

void require_file_of_clone(const Experiment& experiment) {
  if (is_file_of_clone(experiment)) return;
  throw Error("is not the file of the experiment '" + experiment.id +
                  "': it has no reference values to bless",
              experiment.file.string(), file_of_clone(experiment).string());
}

Blessing blessing_of(const std::string& reason) {
  const BuildInfo& build = build_info();
  return {build.git_commit + (build.git_dirty() ? "-modified" : ""), reason};
}

/// Processor time that the run took, where it was recorded.
std::optional<double> processor_seconds(const RunRecord& record) {
  const auto text = record.provenance.find("processor_s");
  if (text == record.provenance.end()) return std::nullopt;
  return std::stod(text->second);
}

void require_metrics(const std::vector<std::string>& names, const Topic& topic) {
  for (const std::string& name : names) {
    if (find_metric(topic, name) != nullptr) continue;
    throw Error("topic '" + topic.name + "' has no metric '" + name + "'", "--rows",
                allowed_names(name, metric_names(topic)));
  }
}

/// A stored run whose frames are those blessed, measured by this very program: now, where it was
/// not. No method runs.
BlessedRun stored_run(const CommandContext& context, Experiment experiment,
                      const ContentHash& blessed) {
  const auto find = [&](bool ours) {
    return find_run_where(experiment.id, [&](const RunRecord& record) {
      const SameBytes same = compare_bytes(record, blessed);
      return record.quick == experiment.quick && (!ours || is_measured_by_us(record)) &&
             (same == SameBytes::all || same == SameBytes::frames);
    });
  };
  std::optional<std::filesystem::path> folder = find(true);
  if (!folder) folder = find(false);
  if (!folder) {
    throw Error("there is no stored run whose frames are those blessed",
                (runs_root() / experiment.id).string(),
                "geoprior bless " + experiment.id + " without --rows, which makes one");
  }
  const OpenedRun run(*folder);
  const LeaveAtOnce section([] { say("stopped: nothing was written"); });
  const Topic& topic = topic_of(experiment, context.topics);
  RunRecord record =
      is_measured_by_us(run.record()) ? run.record() : measure_again(run, context.topics).record;
  return {std::move(experiment), &topic, std::move(record), *folder};
}

/// "overlap_volume.max" is one of the metric's numbers, as is "overlap_volume" of a sequence.
bool is_of(const std::vector<std::string>& metrics, const std::string& name) {
  return std::find(metrics.begin(), metrics.end(), without_statistic(name)) != metrics.end();
}

RunRecord without_metrics(RunRecord record, const std::vector<std::string>& metrics) {
  const auto erase = [&](auto& values) {
    std::erase_if(values, [&](const auto& entry) { return is_of(metrics, entry.first); });
  };
  for (CaseRecord& one : record.cases) {
    for (VariantRecord& variant : one.variants) {
      erase(variant.metrics);
      erase(variant.summary);
    }
  }
  return record;
}

/// Puts the values of the metrics into the set; all others stay.
/// @throws Error  for a metric that the experiment keeps no value of
void put_rows(const ReferenceSet& values, const std::vector<std::string>& metrics,
              ReferenceSet& set) {
  std::set<std::string> kept;
  visit_values(values, [&](const auto& case_name, const auto& variant, const auto& name,
                           const ReferenceValue& value) {
    kept.insert(without_statistic(name));
    if (is_of(metrics, name)) set[case_name][variant][name] = value;
  });
  for (const std::string& metric : metrics) {
    if (kept.contains(metric)) continue;
    throw Error("the experiment keeps no value of the metric '" + metric +
                    "': neither a claim nor its figure nor [check] reads it",
                "--rows", allowed_names(metric, {kept.begin(), kept.end()}));
  }
}

/// `bless --rows`: values of these metrics, of the run that was blessed.
int bless_rows(const CommandContext& context, const BlessRequest& request, Experiment experiment) {
  require_metrics(request.rows, topic_of(experiment, context.topics));
  const std::filesystem::path file = reference_file(experiment.id);
  Reference reference = read_reference(file);
  const std::string size = size_of(experiment);
  const auto blessed = reference.find(size);
  if (blessed == reference.end() || !blessed->second.content) {
    throw Error("there is no blessed run of this size to add rows to", file.string(),
                "geoprior bless " + experiment.id + " without --rows");
  }
  BlessedSet& set = blessed->second;
  const BlessedRun run = stored_run(context, std::move(experiment), *set.content);
  const Gates gates(run.experiment, *run.topic);
  const ReferenceSet before = set.values;
  put_rows(bless_values(gated_values(run.experiment, *run.topic, run.record,
                                     decide_claims(run.experiment, run.record)),
                        gates),
           request.rows, set.values);
  // Only where nothing else was measured otherwise do the bytes stand for the other values.
  if (metrics_sha256(without_metrics(run.record, request.rows)) == set.content->metrics) {
    set.content = content_of(run.record);
    if (run.experiment.keeps_outcomes) set.outcomes = outcomes_of(run.record, *run.topic);
  }
  set.blessing = blessing_of("rows " + joined(request.rows) + ": " + request.reason);
  write_reference(reference, file);
  const std::vector<ReferenceChange> changes = changes_of(before, set.values, gates);
  for (const std::string& line : difference_lines(changes, kMostLines)) say("  " + line);
  say("blessed " + std::to_string(changes.size()) + " values of " + run.experiment.id + " (" +
      size + "), measured in " + run.folder.string() + ", in " + file.string());
  if (context.json) {
    print_json({{"experiment", run.experiment.id},
                {"size", size},
                {"rows", request.rows},
                {"run", run.folder.string()},
                {"changed", changes.size()},
                {"file", file.string()}});
  }
  return done;
}

}  // namespace

int bless_command(const CommandContext& context, const BlessRequest& request) {
  require_reason(request);
  install_stop_handler();
  Experiment experiment = load_without_clock(context, request.id, request.quick);
  require_file_of_clone(experiment);
  if (!request.rows.empty()) return bless_rows(context, request, std::move(experiment));
  const std::filesystem::path file = reference_file(experiment.id);
  Reference reference = read_reference(file);
  const BlessedRun run = run_without_clock(context, std::move(experiment));
  const std::string size = size_of(run.experiment);
  RunRecord graded = run.record;
  graded.claims = decide_claims(run.experiment, run.record);
  require_near_limits(run.experiment, graded.claims);
  grade_claims(run.experiment, context.topics, run.folder, graded);
  const std::vector<ClaimRecord>& claims = graded.claims;
  const Gates gates(run.experiment, *run.topic);
  BlessedSet& set = reference[size];
  const ReferenceSet before = std::move(set.values);
  set = {blessing_of(request.reason), content_of(run.record), processor_seconds(run.record),
         bless_values(gated_values(run.experiment, *run.topic, run.record, claims), gates)};
  if (run.experiment.keeps_outcomes) set.outcomes = outcomes_of(run.record, *run.topic);
  set.claims = bless_claims(claims);
  write_reference(reference, file);

  for (const std::string& failure : failures(run.record)) say("  note: " + failure);
  const std::vector<ReferenceChange> changes = changes_of(before, set.values, gates);
  for (const std::string& line : difference_lines(changes, kMostLines)) say("  " + line);
  for (const ClaimRecord& claim : claims) {
    if (!claim.holds) say("  note: a claim falls short: " + claim.text + ": " + claim.detail);
    if (is_soft(claim)) say("  note: " + claim.text + ": " + grade_text(claim));
  }
  say("blessed " + std::to_string(changes.size()) + " values of " + run.experiment.id + " (" +
      size + ") in " + file.string());
  if (context.json) {
    print_json({{"experiment", run.experiment.id},
                {"size", size},
                {"changed", changes.size()},
                {"file", file.string()}});
  }
  return done;
}

}  // namespace geoprior
