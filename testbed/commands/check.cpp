#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/commands/blessed_run.h"
#include "testbed/commands/catalogue.h"
#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/commands/outcome.h"
#include "testbed/runner/build_info.h"
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

  [[nodiscard]] bool passed() const {
    return has_reference && mismatches.empty() && failures.empty() &&
           std::all_of(claims.begin(), claims.end(), [&](const ClaimRecord& claim) {
             return is_sound(claim) && (claim.holds || known_shortfalls.contains(claim.text));
           });
  }
};

Verdict check_one(const CommandContext& context, const std::string& id, bool quick) {
  const BlessedRun run = run_without_clock(context, id, quick);
  Verdict verdict;
  verdict.id = run.experiment.id;
  verdict.run = run.folder.string();
  verdict.claims = decide_claims(run.experiment, run.record);
  verdict.failures = failures(run.record);
  for (const ClaimSpec& claim : run.experiment.claims) {
    if (claim.known_shortfall) verdict.known_shortfalls[claim.text] = *claim.known_shortfall;
  }
  const Reference reference = read_reference(reference_file(run.experiment.id));
  const auto set = reference.sets.find(run.experiment.quick ? "quick" : "full");
  verdict.has_reference = set != reference.sets.end();
  if (!verdict.has_reference) return verdict;
  for (const CaseRecord& in : run.record.cases) {
    for (const VariantRecord& variant : in.variants) verdict.compared += variant.summary.size();
  }
  verdict.mismatches =
      compare_with_reference(run.record, set->second, tolerances_of(run.experiment, *run.topic));
  return verdict;
}

void say_verdict(const Verdict& verdict, bool quick) {
  const std::string head =
      verdict.passed() ? tinted("ok    ", Tint::good) : tinted("failed", Tint::bad);
  say(head + "  " + verdict.id + "  " + std::to_string(verdict.compared) + " values, " +
      std::to_string(verdict.claims.size()) + " claims");
  if (!verdict.has_reference) {
    say("        no reference values; make them with: geoprior bless " + verdict.id +
        (quick ? " --quick" : "") + " --reason \"…\"");
  }
  for (const std::string& failure : verdict.failures) say("        " + failure);
  for (const Mismatch& mismatch : verdict.mismatches) {
    say("        " + mismatch_text(verdict.id, mismatch));
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
  Json json{{"experiment", verdict.id},     {"passed", verdict.passed()},
            {"run", verdict.run},           {"has_reference", verdict.has_reference},
            {"compared", verdict.compared}, {"failures", verdict.failures},
            {"mismatches", Json::array()},  {"claims", Json::array()}};
  for (const Mismatch& m : verdict.mismatches) {
    json["mismatches"].push_back({{"case", m.case_name},
                                  {"variant", m.variant},
                                  {"metric", m.metric},
                                  {"problem", m.problem},
                                  {"value", json_number(m.value)},
                                  {"reference", json_number(m.reference)},
                                  {"tolerance", json_number(m.tolerance)},
                                  {"unit", m.unit}});
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

}  // namespace

int check_command(const CommandContext& context, const CheckRequest& request) {
  std::vector<std::string> ids = request.ids;
  if (ids.empty()) {
    for (const CatalogueEntry& entry : catalogue()) ids.push_back(entry.id);
  }
  if (ids.empty()) throw Error("there are no experiments to check");
  install_stop_handler();
  Json json = Json::array();
  bool passed = true;
  for (const std::string& id : ids) {
    const Verdict verdict = check_one(context, id, request.quick);
    say_verdict(verdict, request.quick);
    json.push_back(verdict_json(verdict));
    passed = passed && verdict.passed();
  }
  if (context.json) print_json({{"passed", passed}, {"experiments", json}});
  return passed ? done : fell_short;
}

int bless_command(const CommandContext& context, const BlessRequest& request) {
  const bool blank = std::all_of(request.reason.begin(), request.reason.end(),
                                 [](unsigned char c) { return std::isspace(c) != 0; });
  if (blank) {
    throw Error("no reference value changes without a reason", "bless " + request.id,
                "--reason \"why the new values are right\"");
  }
  install_stop_handler();
  const BlessedRun run = run_without_clock(context, request.id, request.quick);
  const std::filesystem::path file = reference_file(run.experiment.id);
  Reference reference = read_reference(file);
  const std::string size = run.experiment.quick ? "quick" : "full";
  const std::vector<Mismatch> before = compare_with_reference(
      run.record, reference.sets[size], [](const std::string&) { return Tolerance{}; });
  const BuildInfo& build = build_info();
  reference.sets[size] = bless_values(run.record, reference.sets[size], request.reason,
                                      build.git_commit + (build.git_dirty() ? "-modified" : ""));
  write_reference(reference, file);
  for (const std::string& failure : failures(run.record)) say("  note: " + failure);
  for (const Mismatch& mismatch : before) {
    if (!std::isnan(mismatch.reference)) say("  " + mismatch_text(run.experiment.id, mismatch));
  }
  for (const ClaimRecord& claim : decide_claims(run.experiment, run.record)) {
    if (!claim.holds) say("  note: a claim falls short: " + claim.text + ": " + claim.detail);
  }
  say("blessed " + std::to_string(before.size()) + " values of " + run.experiment.id + " (" + size +
      ") in " + file.string());
  if (context.json) {
    print_json({{"experiment", run.experiment.id},
                {"size", size},
                {"changed", before.size()},
                {"file", file.string()}});
  }
  return done;
}

}  // namespace geoprior
