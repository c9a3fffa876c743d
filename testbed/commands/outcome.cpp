#include "testbed/commands/outcome.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "testbed/commands/console.h"
#include "testbed/runner/journal/frames_text.h"
#include "testbed/runner/judgement/claims.h"
#include "testbed/runner/judgement/timing_statistics.h"
#include "testbed/runner/number_text.h"

namespace geoprior {
namespace {

using Json = nlohmann::ordered_json;

/// Times of all frames and repetitions.
std::vector<double> all_times(const std::vector<std::vector<double>>& frames) {
  std::vector<double> all;
  for (const auto& repetitions : frames) {
    all.insert(all.end(), repetitions.begin(), repetitions.end());
  }
  return all;
}

std::string time_text(double seconds) {
  if (std::isnan(seconds)) return "-";
  if (seconds < 1e-3) return rounded_text(1e6 * seconds, 3) + " us";
  if (seconds < 1) return rounded_text(1e3 * seconds, 3) + " ms";
  return rounded_text(seconds, 3) + " s";
}

/// "8.31 ms (9.42 ms)": median and 95th percentile.
std::string times_text(const std::vector<std::vector<double>>& frames) {
  const std::vector<double> times = all_times(frames);
  const std::string text = time_text(median(times));
  return times.size() < 2 ? text : text + " (" + time_text(quantile(times, 0.95)) + ")";
}

using Variants = std::vector<std::reference_wrapper<const VariantRecord>>;

Variants without_nulls(const CaseRecord& in) {
  Variants shown;
  std::copy_if(in.variants.begin(), in.variants.end(), std::back_inserter(shown),
               [](const VariantRecord& variant) { return !is_null_control(variant.role); });
  return shown;
}

/// What each variant needed on top of what was there before it; empty where none was measured.
std::vector<std::string> memory_row(const Variants& variants) {
  std::vector<std::string> row{"peak memory", "MB"};
  bool measured = false;
  for (const VariantRecord& variant : variants) {
    measured |= variant.memory.has_value();
    row.push_back(variant.memory ? rounded_text(1e-6 * static_cast<double>(variant.memory->peak -
                                                                           variant.memory->start),
                                                3)
                                 : "-");
  }
  return measured ? row : std::vector<std::string>();
}

void say_case(const CaseRecord& in) {
  std::vector<std::vector<std::string>> rows{{in.name == "default" ? "" : in.name, "unit"}};
  std::map<std::string, std::string> metrics;
  std::set<std::string> phases;
  const Variants shown = without_nulls(in);
  for (const VariantRecord& variant : shown) {
    rows.front().push_back(variant.name);
    for (const auto& [name, value] : variant.summary) {
      const bool detail = name.ends_with(".last") || name.ends_with(".min");
      if (!detail) metrics[name] = value.unit;
    }
    for (const auto& [phase, values] : variant.timing) phases.insert(phase);
  }
  for (const auto& [metric, unit] : metrics) {
    std::vector<std::string> row{metric, unit};
    for (const VariantRecord& variant : shown) {
      const auto found = variant.summary.find(metric);
      row.push_back(found == variant.summary.end() ? "-" : rounded_text(found->second.value));
    }
    rows.push_back(row);
  }
  for (const std::string& phase : phases) {
    std::vector<std::string> row{"time of " + phase + ", median (p95)", ""};
    for (const VariantRecord& variant : shown) {
      const auto found = variant.timing.find(phase);
      row.push_back(found == variant.timing.end() ? "-" : times_text(found->second));
    }
    rows.push_back(row);
  }
  rows.push_back(memory_row(shown));
  if (rows.back().empty()) rows.pop_back();
  say_table(rows);
}

Json null_json(const NullRecord& null) {
  if (null.variant.empty()) return {{"verdict", text_of(null.verdict)}};
  return {{"variant", null.variant},
          {"verdict", text_of(null.verdict)},
          {"left", json_number(null.left)},
          {"right", json_number(null.right)},
          {"detail", null.detail}};
}

Json variant_json(const VariantRecord& variant) {
  Json json{{"name", variant.name},
            {"method", variant.method},
            {"role", variant.role},
            {"status", variant.status},
            {"frames", variant.frames.size()}};
  if (!variant.error.empty()) json["error"] = variant.error;
  if (variant.memory) {
    json["memory_start_bytes"] = variant.memory->start;
    json["memory_peak_bytes"] = variant.memory->peak;
  }
  json["summary"] = Json::object();
  for (const auto& [name, value] : variant.summary) {
    json["summary"][name] = {{"value", json_number(value.value)}, {"unit", value.unit}};
  }
  json["median_time_s"] = Json::object();
  for (const auto& [phase, frames] : variant.timing) {
    json["median_time_s"][phase] = json_number(median(all_times(frames)));
    json["p95_time_s"][phase] = json_number(quantile(all_times(frames), 0.95));
  }
  return json;
}

}  // namespace

std::string claim_count_text(const std::vector<ClaimRecord>& claims) {
  if (claims.empty()) return "none";
  const auto count = [&](ClaimOutcome outcome) {
    return std::count_if(claims.begin(), claims.end(),
                         [&](const ClaimRecord& claim) { return outcome_of(claim) == outcome; });
  };
  std::string text;
  for (const ClaimOutcome outcome :
       {ClaimOutcome::holds, ClaimOutcome::falls_short, ClaimOutcome::not_told_apart}) {
    if (count(outcome) == 0) continue;
    text += (text.empty() ? "" : ", ") + text_of(outcome) + " in " + std::to_string(count(outcome));
    const auto excepted = std::count_if(claims.begin(), claims.end(), [&](const auto& claim) {
      return outcome_of(claim) == outcome && !claim.excepted.empty();
    });
    if (excepted == 0 || outcome == ClaimOutcome::holds) continue;
    text += " (" + std::to_string(excepted) + " excepted)";
  }
  const auto soft = std::count_if(claims.begin(), claims.end(), is_soft);
  return soft == 0 ? text : text + "; " + std::to_string(soft) + " soft";
}

bool all_claims_hold(const RunRecord& record) {
  return std::none_of(record.claims.begin(), record.claims.end(), [](const ClaimRecord& claim) {
    return outcome_of(claim) == ClaimOutcome::falls_short && claim.excepted.empty();
  });
}

std::vector<std::string> failures(const RunRecord& record) {
  std::vector<std::string> lines;
  for (const CaseRecord& in : record.cases) {
    for (const VariantRecord& variant : in.variants) {
      if (variant.status != "failed") continue;
      lines.push_back("variant '" + variant.name + "', case '" + in.name +
                      "': " + failure_text(variant.frames.size(), variant.error));
    }
  }
  return lines;
}

std::string null_text(const ClaimRecord& claim) {
  switch (claim.null.verdict) {
    case Discrimination::discriminates:
      return "discriminates: not so with the null " + claim.null.variant + ": " + claim.null.detail;
    case Discrimination::is_void:
      return "void: its null " + claim.null.variant +
             " passes too, or as good as: " + claim.null.detail;
    case Discrimination::undecided:
      if (is_undecided_time(claim)) return "undecided on this machine: " + claim.null.detail;
      return "undecided: its null " + claim.null.variant + " has no value: " + claim.null.detail;
    case Discrimination::exempt:
      if (!claim.null.detail.empty()) return "needs no null: a time; " + claim.null.detail;
      return "needs no null: a time, or an oracle";
    case Discrimination::unasked:
      break;
  }
  return "names no null: nothing says that it can fail";
}

std::string grade_text(const ClaimRecord& claim) {
  if (claim.grade.of == Graded::not_graded) return {};
  std::string text = is_soft(claim) ? "soft: " : "";
  if (claim.grade.least == 0) {
    text += "the input " + claim.grade.input + " passes";
  } else {
    text += "holds from s = " + rounded_text(claim.grade.least) + " on of " + claim.grade.input +
            " + s (" + (claim.variant.empty() ? "its variant" : claim.variant) + " - " +
            claim.grade.input + ")";
  }
  return text + ", graded by " + text_of(claim.grade.of);
}

void say_claims(const RunRecord& record, bool all_numbers) {
  const std::string indent(16, ' ');
  for (const ClaimRecord& claim : record.claims) {
    const std::string in = claim.case_name.empty() || claim.case_name == "default"
                               ? ""
                               : "  [" + claim.case_name + "]";
    const ClaimOutcome outcome = outcome_of(claim);
    std::string verdict = text_of(outcome);
    verdict.resize(indent.size() - 2, ' ');
    say(tinted(verdict, outcome == ClaimOutcome::holds ? Tint::good : Tint::bad) + "  " +
        claim.text + in);
    const std::string grade = grade_text(claim);
    if (all_numbers || outcome != ClaimOutcome::holds) say(indent + claim.detail);
    if (!claim.excepted.empty()) say(indent + "excepted: " + claim.excepted);
    if (all_numbers || !is_sound(claim)) say(indent + null_text(claim));
    if (!grade.empty() && (all_numbers || is_soft(claim))) say(indent + grade);
    if (!all_numbers) continue;
    if (!claim.nearest.empty()) say(indent + "fails by least: " + claim.nearest);
    if (!claim.passed_too.empty()) say(indent + "holds for " + claim.passed_too + " too");
  }
}

void say_told_files(const RunRecord& record, const std::set<std::string>& names,
                    const std::filesystem::path& folder, bool on_stdout) {
  const auto tell = [&](const std::string& line) {
    on_stdout ? print_out(printable(line) + "\n") : say(line);
  };
  for (const CaseRecord& c : record.cases) {
    for (const VariantRecord& variant : c.variants) {
      for (const StoredFile& file : variant.artifacts) {
        const std::filesystem::path path = folder / file.name;
        if (!names.contains(path.filename().string())) continue;
        tell(path.parent_path().string() + ":");
        std::ifstream in(path);
        for (std::string line; std::getline(in, line);) tell("  " + line);
      }
    }
  }
}

void say_studies(const RunRecord& record) {
  for (const StudyRecord& study : record.studies) {
    const std::string interval = std::isnan(study.low) ? ""
                                                       : " [" + rounded_text(study.low) + ", " +
                                                             rounded_text(study.high) + "]";
    say("study        " + study.name + ": " + study.kind + " of " + study.quantity + " " +
        rounded_text(study.value) + interval);
  }
}

void say_summary(const RunRecord& record, std::size_t most_cases) {
  std::size_t cases = 0;
  for (const CaseRecord& in : record.cases) {
    if (in.claims_only || ++cases > most_cases) continue;
    say_case(in);
    say();
  }
  if (cases > most_cases) {
    say("  … and " + std::to_string(cases - most_cases) + " more cases: see the report");
  }
}

Json outcome_json(const RunRecord& record, const std::filesystem::path& folder) {
  Json json{{"experiment", record.experiment_id},
            {"quick", record.quick},
            {"run", folder.string()},
            {"spec_hash", record.spec_hash},
            {"content_sha256", record.content_sha256},
            {"frames_sha256", record.frames_sha256},
            {"metrics_sha256", record.metrics_sha256}};
  json["claims"] = Json::array();
  for (const ClaimRecord& claim : record.claims) {
    json["claims"].push_back({{"text", claim.text},
                              {"case", claim.case_name},
                              {"detail", claim.detail},
                              {"left", json_number(claim.left)},
                              {"right", json_number(claim.right)},
                              {"holds", claim.holds},
                              {"outcome", text_of(outcome_of(claim))},
                              {"null", null_json(claim.null)},
                              {"holds_too_for", claim.passed_too},
                              {"fails_by_least", claim.nearest}});
    if (!claim.excepted.empty()) json["claims"].back()["excepted"] = claim.excepted;
    if (claim.grade.of != Graded::not_graded) {
      json["claims"].back()["grade"] = {{"input", claim.grade.input},
                                        {"of", text_of(claim.grade.of)},
                                        {"least", json_number(claim.grade.least)},
                                        {"soft", is_soft(claim)}};
    }
    if (const auto ratio = slack(claim)) json["claims"].back()["value_over_limit"] = *ratio;
  }
  json["studies"] = Json::array();
  for (const StudyRecord& study : record.studies) {
    json["studies"].push_back({{"name", study.name},
                               {"kind", study.kind},
                               {"quantity", study.quantity},
                               {"value", json_number(study.value)},
                               {"low", json_number(study.low)},
                               {"high", json_number(study.high)}});
  }
  json["cases"] = Json::array();
  for (const CaseRecord& in : record.cases) {
    Json entry{{"name", in.name}, {"variants", Json::array()}};
    for (const VariantRecord& variant : in.variants)
      entry["variants"].push_back(variant_json(variant));
    json["cases"].push_back(entry);
  }
  return json;
}

}  // namespace geoprior
