#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "testbed/catalogue.h"
#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/commands/find.h"
#include "testbed/commands/outcome.h"
#include "testbed/runner/judgement/claims.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/spec/spec.h"

namespace geoprior {
namespace {

using Json = nlohmann::ordered_json;

std::optional<RunRecord> newest_run(const std::string& id) {
  try {
    return OpenedRun(run_folder_of(id)).record();
  } catch (const Error&) {
    return std::nullopt;  // none yet
  }
}

std::vector<ClaimRecord> decided(const ClaimSpec& claim, const std::optional<RunRecord>& run) {
  std::vector<ClaimRecord> records;
  if (!run) return records;
  std::copy_if(run->claims.begin(), run->claims.end(), std::back_inserter(records),
               [&](const ClaimRecord& record) { return record.text == claim.text; });
  return records;
}

/// "0.2 … 0.9" over the cases.
std::string slack_text(const std::vector<ClaimRecord>& records) {
  std::vector<double> values;
  for (const ClaimRecord& record : records) {
    if (const std::optional<double> value = slack(record)) values.push_back(*value);
  }
  if (values.empty()) return "-";
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *low == *high ? rounded_text(*low) : rounded_text(*low) + " … " + rounded_text(*high);
}

std::string verdict_text(const std::vector<ClaimRecord>& records) {
  if (records.empty()) return "-";
  // The least that the null says in any case.
  const auto unsound = std::find_if_not(records.begin(), records.end(), is_sound);
  const ClaimRecord& telling = unsound == records.end() ? records.front() : *unsound;
  return claim_count_text(records) + ", " + text_of(telling.null.verdict);
}

Json claim_json(const ClaimSpec& claim, const std::vector<ClaimRecord>& records) {
  Json json{{"text", claim.text}, {"metric", claim.metric}};
  if (claim.variants.empty()) json["variant"] = claim.variant;
  if (!claim.variants.empty()) json["variants"] = claim.variants;
  if (claim.null) json["null"] = *claim.null;
  json["cases"] = Json::array();
  for (const ClaimRecord& record : records) {
    json["cases"].push_back({{"case", record.case_name},
                             {"holds", record.holds},
                             {"outcome", text_of(outcome_of(record))},
                             {"null", text_of(record.null.verdict)}});
    if (const auto value = slack(record)) json["cases"].back()["value_over_limit"] = *value;
  }
  return json;
}

}  // namespace

int list_claims_command(const CommandContext& context) {
  Json json = Json::array();
  for (const CatalogueEntry& entry : catalogue()) {
    const Experiment experiment = load_experiment(entry.file, context.topics, {});
    const std::optional<RunRecord> run = newest_run(entry.id);
    std::vector<std::vector<std::string>> rows{
        {"claim", "metric", "null", "verdict", "value / limit"}};
    Json claims = Json::array();
    std::string before;
    for (const ClaimSpec& claim : experiment.claims) {
      if (claim.text == before) continue;  // another variant of the same claim
      before = claim.text;
      const std::vector<ClaimRecord> records = decided(claim, run);
      rows.push_back({claim.text, claim.metric, claim.null.value_or("-"), verdict_text(records),
                      slack_text(records)});
      claims.push_back(claim_json(claim, records));
    }
    if (context.json) {
      json.push_back({{"experiment", entry.id}, {"claims", claims}});
      continue;
    }
    say(tinted(entry.id, Tint::strong) +
        (run ? run->quick ? "  (newest run: quick)" : "" : "  (no run yet)"));
    if (rows.size() > 1) say_table(rows);
    say();
  }
  if (context.json) print_json(json);
  return done;
}

}  // namespace geoprior
