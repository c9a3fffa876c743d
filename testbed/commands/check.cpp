#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "testbed/catalogue.h"
#include "testbed/commands/blessed_run.h"
#include "testbed/commands/check_jobs.h"
#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/commands/find.h"
#include "testbed/commands/outcome.h"
#include "testbed/runner/judgement/claims.h"
#include "testbed/runner/judgement/grades.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/reference/diff.h"
#include "testbed/runner/reference/reference.h"
#include "testbed/runner/reference/run_difference.h"
#include "testbed/runner/run_folder.h"

namespace geoprior {
namespace {

using Json = nlohmann::ordered_json;

/// Of the values that moved, those that are listed: the farthest, in tolerances.
constexpr std::size_t kMostMoved = 12;

/// What a check found of one experiment.
struct Verdict {
  std::string id;
  std::string run;
  std::size_t compared = 0;
  std::vector<Mismatch> mismatches;
  std::vector<ClaimRecord> claims;
  std::vector<std::string> failures;  ///< of variants that an error ended, and of outcomes
  std::map<std::string, std::string> known_shortfalls;  ///< text of a claim, why it falls short
  bool has_reference = true;
  bool is_of_clone = true;     ///< where it has no reference: else none can be blessed
  bool mutations = false;      ///< asked for: a method replaced by its null must be noticed
  bool mutation_seen = false;  ///< by at least one claim
  bool names_nulls = false;    ///< a claim of this size that is not known to fall short does
  bool same_bytes = false;     ///< as the blessed run: its values need no comparison
  /// Why the values were compared although nothing need have changed, and how the frames differ.
  std::vector<std::string> notices;

  [[nodiscard]] bool passed() const {
    return has_reference && failures.empty() && (mutation_seen || !mutations || !names_nulls) &&
           std::none_of(mismatches.begin(), mismatches.end(),
                        [](const Mismatch& mismatch) { return mismatch.fails; }) &&
           unsound(claims).empty() && std::all_of(claims.begin(), claims.end(), [&](const auto& c) {
             return c.holds || !c.excepted.empty() || known_shortfalls.contains(c.text);
           });
  }
};

/// Says how the run's bytes stand to the blessed ones; frames that are others are held against the
/// blessed run's where that one is still there.
void compare_contents(const BlessedRun& run, const ContentHash& blessed, Verdict& verdict) {
  std::vector<std::string>& notices = verdict.notices;
  switch (compare_bytes(run.record, blessed)) {
    case SameBytes::all:
      verdict.same_bytes = true;
      return;
    case SameBytes::incomparable:
      notices.push_back("blessed on " + blessed.instruction_set + ", run on " +
                        content_of(run.record).instruction_set);
      return;
    case SameBytes::frames:
      notices.emplace_back("frames are those blessed, metrics are not, byte by byte");
      return;
    case SameBytes::none:
      break;
  }
  notices.emplace_back("frames are not those blessed, byte by byte");
  const auto before = find_run_where(run.experiment.id, [&](const RunRecord& record) {
    const SameBytes same = compare_bytes(record, blessed);
    return same == SameBytes::all || same == SameBytes::frames;
  });
  if (!before) return;
  notices.push_back("compared with the run that was blessed, " + before->string());
  for (std::string& line : frame_differences(OpenedRun(run.folder, run.record), OpenedRun(*before)))
    notices.push_back(std::move(line));
}

/// The stored values that moved, those within their tolerance as well.
void add_moved_values(const GatedValues& now, const ReferenceSet& before, const Gates& gates,
                      Verdict& verdict) {
  std::vector<ReferenceChange> moved = changes_of(before, bless_values(now, gates), gates);
  std::erase_if(moved, [](const ReferenceChange& change) {
    return change.kind != ReferenceChange::Kind::moved;
  });
  const std::vector<std::string> lines = difference_lines(moved, kMostMoved);
  if (lines.empty()) verdict.notices.emplace_back("no stored value moved");
  for (const std::string& line : lines) verdict.notices.push_back("moved: " + line);
}

/// Which columns came to something else, and which now come to the same.
void add_outcomes(const BlessedRun& run, const Outcomes& blessed, Verdict& verdict) {
  Outcomes now;
  if (run.experiment.keeps_outcomes) now = outcomes_of(run.record, *run.topic);
  const OutcomeDifference difference = compare_outcomes(now, blessed);
  const auto append = [](std::vector<std::string>& all, const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  append(verdict.notices, difference.notices);
  append(verdict.failures, difference.failures);
}

/// A grade is looked for again only around the blessed one: there or a step above it the claim must
/// hold, and not at both of the steps below.
void check_grades(const CommandContext& context, const BlessedRun& run,
                  const BlessedClaims& blessed, Verdict& verdict) {
  Grader grader(run.experiment, context.topics, run.record, run.folder);
  for (const std::string& in : cases_of(verdict.claims)) {
    for (const ClaimRecord& claim : verdict.claims) {
      if (claim.case_name != in) continue;
      const BlessedClaim* before = find_claim(blessed, claim);
      if (before == nullptr || before->graded == Graded::not_graded) continue;
      const int step = static_cast<int>(std::lround(before->least * kGradeSteps));
      const auto holds_at = [&](int at) {
        return at >= 0 && at <= kGradeSteps && grader.holds_at(claim, before->graded, at) == true;
      };
      // A mixture of two that pass may fail.
      const bool above = holds_at(step) || holds_at(step + 1);
      const bool below = holds_at(step - 2) && holds_at(step - 1);
      if (above && !below) continue;
      verdict.failures.push_back("claim '" + claim.text + "', case '" + in + "': its grade is " +
                                 (below ? "less" : "more") + " than the blessed one, " +
                                 number_text(before->least));
    }
  }
}

void compare_claims(const CommandContext& context, const BlessedRun& run, const BlessedSet& set,
                    Verdict& verdict) {
  if (set.claims.empty() && !verdict.claims.empty()) {
    verdict.notices.emplace_back("its claims are not blessed yet");
    return;
  }
  for (std::string& line : changed_claims(verdict.claims, set.claims)) {
    verdict.failures.push_back(std::move(line));
  }
  if (verdict.mutations) check_grades(context, run, set.claims, verdict);
}

Verdict check_one(const CommandContext& context, const std::string& id,
                  const CheckRequest& request) {
  Experiment experiment = load_without_clock(context, id, request.quick);
  const Reference reference = read_reference(reference_file(experiment.id));
  const BlessedRun run = run_without_clock(context, std::move(experiment));
  Verdict verdict;
  verdict.id = run.experiment.id;
  verdict.run = run.folder.string();
  verdict.claims = decide_claims(run.experiment, run.record);
  verdict.mutations = request.mutations;
  verdict.names_nulls =
      std::any_of(run.experiment.claims.begin(), run.experiment.claims.end(),
                  [](const ClaimSpec& claim) { return claim.null && !claim.known_shortfall; });
  verdict.mutation_seen =
      std::any_of(verdict.claims.begin(), verdict.claims.end(), [](const ClaimRecord& claim) {
        return claim.holds && claim.null.verdict == Discrimination::discriminates;
      });
  verdict.failures = failures(run.record);
  for (const ClaimSpec& claim : run.experiment.claims) {
    if (claim.known_shortfall) verdict.known_shortfalls[claim.text] = *claim.known_shortfall;
  }
  const auto blessed = reference.find(size_of(run.experiment));
  verdict.has_reference = blessed != reference.end();
  if (!verdict.has_reference) {
    verdict.is_of_clone = is_file_of_clone(run.experiment);
    return verdict;
  }
  GatedValues now = gated_values(run.experiment, *run.topic, run.record, verdict.claims);
  ReferenceSet before = blessed->second.values;
  verdict.compared = count_values(now);
  if (blessed->second.content) compare_contents(run, *blessed->second.content, verdict);
  if (verdict.same_bytes) {
    keep_outside_content(now);
    keep_outside_content(before);
  }
  const Gates gates(run.experiment, *run.topic);
  if (!verdict.notices.empty()) add_moved_values(now, before, gates, verdict);
  verdict.mismatches = compare_with_reference(now, before, gates);
  add_outcomes(run, blessed->second.outcomes, verdict);
  compare_claims(context, run, blessed->second, verdict);
  return verdict;
}

void say_verdict(const Verdict& verdict, bool quick) {
  const std::string head =
      verdict.passed() ? tinted("ok    ", Tint::good) : tinted("failed", Tint::bad);
  say(head + "  " + verdict.id + "  " + std::to_string(verdict.compared) + " values" +
      (verdict.same_bytes ? " (same bytes), " : ", ") + std::to_string(verdict.claims.size()) +
      " claims");
  for (const std::string& notice : verdict.notices) say("        notice: " + notice);
  if (!verdict.has_reference && verdict.is_of_clone) {
    say("        no reference values; make them with: geoprior bless " + verdict.id +
        (quick ? " --quick" : "") + " --reason \"…\"");
  } else if (!verdict.has_reference) {
    say("        no reference values: only experiments of the clone get some; what changed since "
        "another run: geoprior compare <run> " +
        verdict.run);
  }
  for (const std::string& failure : verdict.failures) say("        " + failure);
  for (const Mismatch& mismatch : verdict.mismatches) {
    say(std::string("        ") + (mismatch.fails ? "" : "notice: ") +
        mismatch_text(verdict.id, mismatch));
  }
  if (verdict.mutations && !verdict.names_nulls) {
    say("        notice: no claim of " + verdict.id + " of this size names a null");
  } else if (verdict.mutations && !verdict.mutation_seen) {
    say("        " + verdict.id + ": no claim notices that a method is replaced by its null");
  }
  for (const ClaimRecord& claim : unsound(verdict.claims)) {
    say("        " + verdict.id + ", case '" + claim.case_name + "', claim: " + claim.text + ": " +
        null_text(claim));
  }
  for (const ClaimRecord& claim : verdict.claims) {
    if (outcome_of(claim) == ClaimOutcome::holds && !claim.excepted.empty()) {
      say("        notice: " + verdict.id + ", case '" + claim.case_name +
          "' is excepted, and the claim holds there: " + claim.text);
    }
    if (claim.holds || !claim.excepted.empty()) continue;
    say("        " + verdict.id + ", case '" + claim.case_name +
        "', claim falls short: " + claim.text + ": " + claim.detail);
    if (const auto known = verdict.known_shortfalls.find(claim.text);
        known != verdict.known_shortfalls.end()) {
      say("        known: " + known->second);
    }
  }
}

Json verdict_json(const Verdict& verdict) {
  Json json{{"experiment", verdict.id},
            {"passed", verdict.passed()},
            {"run", verdict.run},
            {"has_reference", verdict.has_reference},
            {"compared", verdict.compared},
            {"failures", verdict.failures},
            {"same_bytes", verdict.same_bytes},
            {"mutation_seen", verdict.mutation_seen},
            {"notices", verdict.notices},
            {"mismatches", Json::array()},
            {"claims", Json::array()}};
  for (const Mismatch& m : verdict.mismatches) {
    json["mismatches"].push_back({{"case", m.case_name},
                                  {"variant", m.variant},
                                  {"metric", m.metric},
                                  {"problem", m.problem},
                                  {"value", json_number(m.value)},
                                  {"reference", json_number(m.reference)},
                                  {"tolerance", json_number(m.tolerance)},
                                  {"unit", m.unit},
                                  {"fails", m.fails}});
  }
  for (const ClaimRecord& claim : verdict.claims) {
    json["claims"].push_back({{"text", claim.text},
                              {"case", claim.case_name},
                              {"detail", claim.detail},
                              {"holds", claim.holds},
                              {"outcome", text_of(outcome_of(claim))},
                              {"null", text_of(claim.null.verdict)}});
  }
  return json;
}

/// One after the other, in this process.
int check_in_turn(const CommandContext& context, const CheckRequest& request,
                  const std::vector<std::string>& ids) {
  install_stop_handler();
  Json json = Json::array();
  bool passed = true;
  for (const std::string& id : ids) {
    throw_if_stopped();
    const Verdict verdict = check_one(context, id, request);
    say_verdict(verdict, request.quick);
    json.push_back(verdict_json(verdict));
    passed = passed && verdict.passed();
  }
  if (context.json) print_json({{"passed", passed}, {"experiments", json}});
  return passed ? done : fell_short;
}

/// Without repetitions of the same file.
std::vector<std::string> each_once(const std::vector<std::string>& ids) {
  std::vector<std::string> kept;
  std::set<std::filesystem::path> files;
  for (const std::string& id : ids) {
    if (files.insert(std::filesystem::weakly_canonical(experiment_file(id))).second) {
      kept.push_back(id);
    }
  }
  return kept;
}

}  // namespace

int check_command(const CommandContext& context, const CheckRequest& request) {
  std::vector<std::string> ids = request.ids;
  if (ids.empty()) {
    for (const CatalogueEntry& entry : catalogue()) ids.push_back(entry.id);
  }
  if (ids.empty()) throw Error("there are no experiments to check");
  ids = each_once(ids);
  if (request.jobs > 1 && ids.size() > 1) return check_in_jobs(context, request, ids);
  int code = done;
  with_threads(request.threads, [&] { code = check_in_turn(context, request, ids); });
  return code;
}

}  // namespace geoprior
