#include <algorithm>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/error.h"
#include "testbed/commands/blessed_run.h"
#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/commands/outcome.h"
#include "testbed/home.h"
#include "testbed/runner/build_info.h"
#include "testbed/runner/claims.h"
#include "testbed/runner/reference_diff.h"
#include "testbed/runner/stop.h"

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

/// A reference belongs to the experiment of the clone that has this identifier; a file elsewhere
/// may call itself what it likes.
void require_file_of_clone(const Experiment& experiment) {
  namespace fs = std::filesystem;
  const fs::path own = geoprior_home() / "experiments" / (experiment.id + ".toml");
  if (fs::weakly_canonical(experiment.file) == fs::weakly_canonical(own)) return;
  throw Error("is not the file of the experiment '" + experiment.id +
                  "': it has no reference values to bless",
              experiment.file.string(), own.string());
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

}  // namespace

int bless_command(const CommandContext& context, const BlessRequest& request) {
  require_reason(request);
  install_stop_handler();
  Experiment experiment = load_without_clock(context, request.id, request.quick);
  require_file_of_clone(experiment);
  const std::filesystem::path file = reference_file(experiment.id);
  Reference reference = read_reference(file);
  const BlessedRun run = run_without_clock(context, std::move(experiment));
  const std::string size = size_of(run.experiment);
  const std::vector<ClaimRecord> claims = decide_claims(run.experiment, run.record);
  const Gates gates(run.experiment, *run.topic);
  BlessedSet& set = reference[size];
  const ReferenceSet before = std::move(set.values);
  set = {blessing_of(request.reason), content_of(run.record), processor_seconds(run.record),
         bless_values(gated_values(run.experiment, *run.topic, run.record, claims), gates)};
  write_reference(reference, file);

  for (const std::string& failure : failures(run.record)) say("  note: " + failure);
  const std::vector<ReferenceChange> changes = changes_of(before, set.values, gates);
  for (const std::string& line : difference_lines(changes, kMostLines)) say("  " + line);
  for (const ClaimRecord& claim : claims) {
    if (!claim.holds) say("  note: a claim falls short: " + claim.text + ": " + claim.detail);
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
