#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "testbed/commands/blessed_run.h"
#include "testbed/commands/catalogue.h"
#include "testbed/commands/check_jobs.h"
#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/commands/outcome.h"
#include "testbed/runner/claims.h"
#include "testbed/runner/reference.h"
#include "testbed/runner/stop.h"

namespace geoprior {
namespace {

using Json = nlohmann::ordered_json;

/// What a check found of one experiment.
struct Verdict {
  std::string id;
  std::string run;
  std::size_t compared = 0;
  std::vector<Mismatch> mismatches;
  std::vector<ClaimRecord> claims;
  std::vector<std::string> failures;                    ///< of variants that an error ended
  std::map<std::string, std::string> known_shortfalls;  ///< text of a claim, why it falls short
  bool has_reference = true;
  bool mutations = false;      ///< asked for: a method replaced by its null must be noticed
  bool mutation_seen = false;  ///< by at least one claim
  bool same_bytes = false;     ///< as the blessed run: its values need no comparison
  std::string notice;          ///< why the values were compared although nothing need have changed

  [[nodiscard]] bool passed() const {
    return has_reference && failures.empty() && (mutation_seen || !mutations) &&
           std::none_of(mismatches.begin(), mismatches.end(),
                        [](const Mismatch& mismatch) { return mismatch.fails; }) &&
           std::all_of(claims.begin(), claims.end(), [&](const ClaimRecord& claim) {
             return is_sound(claim) && (claim.holds || known_shortfalls.contains(claim.text));
           });
  }
};

/// Decides whether frames and metrics are those of the blessed run, byte by byte.
void compare_contents(const RunRecord& record, const ContentHash& blessed, Verdict& verdict) {
  const ContentHash now = content_of(record);
  if (now.instruction_set != blessed.instruction_set) {
    verdict.notice = "blessed on " + blessed.instruction_set + ", run on " + now.instruction_set;
    return;
  }
  verdict.same_bytes = now.sha256 == blessed.sha256;
  if (!verdict.same_bytes) verdict.notice = "frames or metrics are not those blessed, byte by byte";
}

Verdict check_one(const CommandContext& context, const std::string& id,
                  const CheckRequest& request) {
  const BlessedRun run = run_without_clock(context, load_without_clock(context, id, request.quick));
  Verdict verdict;
  verdict.id = run.experiment.id;
  verdict.run = run.folder.string();
  verdict.claims = decide_claims(run.experiment, run.record);
  verdict.mutations = request.mutations;
  verdict.mutation_seen =
      std::any_of(verdict.claims.begin(), verdict.claims.end(), [](const ClaimRecord& claim) {
        return claim.holds && claim.null.verdict == Discrimination::discriminates;
      });
  verdict.failures = failures(run.record);
  for (const ClaimSpec& claim : run.experiment.claims) {
    if (claim.known_shortfall) verdict.known_shortfalls[claim.text] = *claim.known_shortfall;
  }
  const Reference reference = read_reference(reference_file(run.experiment.id));
  const std::string size = run.experiment.quick ? "quick" : "full";
  const auto set = reference.sets.find(size);
  verdict.has_reference = set != reference.sets.end();
  if (!verdict.has_reference) return verdict;
  GatedValues now = gated_values(run.experiment, *run.topic, run.record, verdict.claims);
  ReferenceSet before = set->second;
  verdict.compared = count_values(now);
  const auto blessed = reference.contents.find(size);
  if (blessed != reference.contents.end()) compare_contents(run.record, blessed->second, verdict);
  if (verdict.same_bytes) {
    keep_outside_content(now);
    keep_outside_content(before);
  }
  verdict.mismatches = compare_with_reference(now, before, Gates(run.experiment, *run.topic));
  return verdict;
}

void say_verdict(const Verdict& verdict, bool quick) {
  const std::string head =
      verdict.passed() ? tinted("ok    ", Tint::good) : tinted("failed", Tint::bad);
  say(head + "  " + verdict.id + "  " + std::to_string(verdict.compared) + " values" +
      (verdict.same_bytes ? " (same bytes), " : ", ") + std::to_string(verdict.claims.size()) +
      " claims");
  if (!verdict.notice.empty()) say("        notice: " + verdict.notice);
  if (!verdict.has_reference) {
    say("        no reference values; make them with: geoprior bless " + verdict.id +
        (quick ? " --quick" : "") + " --reason \"…\"");
  }
  for (const std::string& failure : verdict.failures) say("        " + failure);
  for (const Mismatch& mismatch : verdict.mismatches) {
    say(std::string("        ") + (mismatch.fails ? "" : "notice: ") +
        mismatch_text(verdict.id, mismatch));
  }
  if (verdict.mutations && !verdict.mutation_seen) {
    say("        " + verdict.id + ": no claim notices that a method is replaced by its null");
  }
  for (const ClaimRecord& claim : verdict.claims) {
    if (!is_sound(claim)) {
      say("        " + verdict.id + ", case '" + claim.case_name + "', claim: " + claim.text +
          ": " + null_text(claim));
    }
    if (claim.holds) continue;
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
            {"notice", verdict.notice},
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
