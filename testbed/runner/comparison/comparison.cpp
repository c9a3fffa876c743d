#include "testbed/runner/comparison/comparison.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "core/error.h"
#include "testbed/joined.h"
#include "testbed/runner/benchmark.h"
#include "testbed/runner/judgement/measure.h"
#include "testbed/runner/judgement/timing_statistics.h"
#include "testbed/runner/reference/gates.h"
#include "testbed/runner/reference/headlines.h"
#include "testbed/runner/spec/claims.h"
#include "testbed/runner/spec/overrides.h"

namespace geoprior {
namespace {

constexpr double kNoSuchValue = std::numeric_limits<double>::quiet_NaN();
/// Of the keys in which specifications differ, those that a refusal lists.
constexpr std::size_t kMostRefusedKeys = 8;

/// A variant that is in both runs.
struct VariantPair {
  const CaseRecord* case_before = nullptr;
  const CaseRecord* case_after = nullptr;
  const VariantRecord* before = nullptr;
  const VariantRecord* after = nullptr;
  std::string label;
};

/// The two records with their specifications.
struct Sides {
  const RunRecord& before;
  const RunRecord& after;
  TomlNode spec_before;
  TomlNode spec_after;
};

TomlNode recorded_specification(const OpenedRun& run) {
  return parse_toml_text(run.record().experiment_toml, (run.folder() / "run.h5").string());
}

const CaseRecord* case_named(const RunRecord& record, const std::string& name) {
  const auto found = std::find_if(record.cases.begin(), record.cases.end(),
                                  [&](const CaseRecord& in) { return in.name == name; });
  return found == record.cases.end() ? nullptr : &*found;
}

void require_same_specification(const std::vector<KeyDifference>& keys, const std::string& place) {
  if (keys.empty()) return;
  std::string list;
  for (std::size_t i = 0; i < std::min(keys.size(), kMostRefusedKeys); ++i) {
    list += (i == 0 ? "" : "; ") + keys[i].key + ": " + keys[i].before + " -> " + keys[i].after;
  }
  if (keys.size() > kMostRefusedKeys) {
    list += "; and " + std::to_string(keys.size() - kMostRefusedKeys) + " more";
  }
  throw Error("have different specifications: " + list, place,
              "runs of one specification, or --common, which compares what both have");
}

void require_variant(const RunRecord& record, const std::string& name, const std::string& which) {
  std::set<std::string> names;
  for (const CaseRecord& in : record.cases) {
    for (const VariantRecord& variant : in.variants) names.insert(variant.name);
  }
  if (names.contains(name)) return;
  throw Error("there is no variant '" + name + "' in the " + which + " run", "--variants",
              allowed_names(name, {names.begin(), names.end()}));
}

/// The variants of a case by the names that the request gives them; those of equal name without.
std::vector<VariantPair> pairs_in(const CaseRecord& before, const CaseRecord& after,
                                  const ComparisonRequest& request) {
  std::vector<std::pair<std::string, std::string>> names = request.variants;
  if (names.empty()) {
    for (const VariantRecord& variant : before.variants) {
      names.emplace_back(variant.name, variant.name);
    }
  }
  std::vector<VariantPair> pairs;
  for (const auto& [a, b] : names) {
    const VariantRecord* old = find_variant(before, a);
    const VariantRecord* now = find_variant(after, b);
    if (old == nullptr || now == nullptr) continue;
    pairs.push_back({&before, &after, old, now, a == b ? a : a + " → " + b});
  }
  return pairs;
}

std::vector<VariantPair> pairs_of(const Sides& sides, const ComparisonRequest& request) {
  std::vector<VariantPair> pairs;
  for (const CaseRecord& before : sides.before.cases) {
    const CaseRecord* after = case_named(sides.after, before.name);
    if (after == nullptr || before.claims_only || after->claims_only) continue;
    const std::vector<VariantPair> in_case = pairs_in(before, *after, request);
    pairs.insert(pairs.end(), in_case.begin(), in_case.end());
  }
  return pairs;
}

/// Cases and variants of a run that the other one lacks.
std::vector<std::string> missing_in(const RunRecord& other, const RunRecord& record) {
  std::vector<std::string> missing;
  for (const CaseRecord& in : record.cases) {
    if (in.claims_only) continue;
    const CaseRecord* same = case_named(other, in.name);
    if (same == nullptr) {
      missing.push_back("case '" + in.name + "'");
      continue;
    }
    for (const VariantRecord& variant : in.variants) {
      if (find_variant(*same, variant.name) != nullptr) continue;
      missing.push_back("variant '" + variant.name + "', case '" + in.name + "'");
    }
  }
  return missing;
}

std::string status_text(const VariantRecord& variant) {
  return variant.error.empty() ? variant.status : variant.status + ": " + variant.error;
}

/// Takes out the pairs of which one failed, and lists them.
std::vector<StatusChange> take_failures(std::vector<VariantPair>& pairs) {
  std::vector<StatusChange> changes;
  std::erase_if(pairs, [&](const VariantPair& pair) {
    if (pair.before->status == pair.after->status) return false;
    const bool fell = pair.after->status != "done" && !is_null_control(pair.after->role);
    const Change change = fell                           ? Change::worse
                          : pair.after->status == "done" ? Change::better
                                                         : Change::changed;
    changes.push_back({change, pair.case_after->name, pair.label, status_text(*pair.before),
                       status_text(*pair.after)});
    return true;
  });
  return changes;
}

/// Compares summary values: those of all pairs, or of an experiment that bifurcates their medians
/// over the seeds.
class ValueComparison {
 public:
  ValueComparison(const Sides& sides, const Topic& topic, const ComparisonRequest& request)
      : sides_(sides),
        topic_(topic),
        gates_(with_tolerances(sides, topic), topic),
        absent_is_a_loss_(!request.common && request.variants.empty()) {}

  void compare(const std::vector<VariantPair>& pairs, RunComparison& result) {
    for (const VariantPair& pair : pairs) add(pair);
    if (bifurcates()) {
      before_ = medians_over_seeds(sides_.before, before_);
      after_ = medians_over_seeds(sides_.after, after_);
    }
    list_metrics(result);
    visit_both([&](ValueChange value, bool both) { judge(std::move(value), both, result); });
    std::stable_sort(result.values.begin(), result.values.end(), [](const auto& a, const auto& b) {
      const auto rank = [](const ValueChange& v) {
        return std::tuple(v.change == Change::lost ? Change::worse : v.change, -v.tolerances());
      };
      return rank(a) < rank(b);
    });
  }

 private:
  static Experiment with_tolerances(const Sides& sides, const Topic& topic) {
    Experiment experiment;
    experiment.tolerances = read_tolerances(sides.spec_after, topic);
    return experiment;
  }

  [[nodiscard]] bool bifurcates() const {
    const auto says_so = [](const TomlNode& root) {
      const TomlNode* check = root.find("check");
      const TomlNode* key = check == nullptr ? nullptr : check->find("bifurcates");
      return key != nullptr && key->boolean;
    };
    return says_so(sides_.spec_before) && says_so(sides_.spec_after);
  }

  void add(const VariantPair& pair) {
    if (is_null_control(pair.before->role) || is_null_control(pair.after->role)) {
      unjudged_[pair.label] = "null control";
    } else if (!has_gated_method(topic_, *pair.after)) {
      unjudged_[pair.label] = "does not repeat";
    }
    const auto put = [&](const CaseRecord& in, const VariantRecord& variant, GatedValues& values) {
      for (const auto& [name, value] : variant.summary) {
        values[in.name][pair.label][name] = {value.value, value.unit};
        recorded_direction_[without_statistic(name)] = value.direction;
      }
    };
    put(*pair.case_before, *pair.before, before_);
    put(*pair.case_after, *pair.after, after_);
  }

  static std::set<std::string> metrics_of(const GatedValues& values) {
    std::set<std::string> names;
    visit_values(values, [&](const auto&, const auto&, const std::string& name, const auto&) {
      names.insert(without_statistic(name));
    });
    return names;
  }

  /// Metrics that one of the runs does not have at all are named once, not at each variant.
  void list_metrics(RunComparison& result) {
    const std::set<std::string> before = metrics_of(before_), after = metrics_of(after_);
    for (const std::string& name : before) {
      if (after.contains(name)) continue;
      const MetricEntry* row = find_metric(topic_, name);
      const bool judged = row != nullptr && row->gated() && row->direction != Direction::none;
      const bool lost = absent_is_a_loss_ && judged;
      (lost ? result.lost : result.gone).push_back(name);
    }
    for (const std::string& name : after) {
      if (!before.contains(name)) result.added.push_back(name);
    }
    in_one_only_ = {result.lost.begin(), result.lost.end()};
    in_one_only_.insert(result.gone.begin(), result.gone.end());
    in_one_only_.insert(result.added.begin(), result.added.end());
  }

  /// visit(value, whether both sides have it), without direction and tolerance.
  template <class Visit>
  void visit_both(Visit visit) const {
    visit_values(before_,
                 [&](const auto& in, const auto& variant, const auto& name, const GatedValue& old) {
                   ValueChange value{Change::changed, in, variant, name, old.unit};
                   const GatedValue* now = find_value(after_, in, variant, name);
                   value.before = old.value;
                   value.after = now == nullptr ? kNoSuchValue : now->value;
                   if (now != nullptr && now->unit != old.unit) {
                     value.unit += " → " + now->unit;
                     value.unjudged = "other unit";
                   }
                   visit(value, now != nullptr);
                 });
    visit_values(after_,
                 [&](const auto& in, const auto& variant, const auto& name, const GatedValue& now) {
                   if (find_value(before_, in, variant, name) != nullptr) return;
                   ValueChange value{Change::changed, in, variant, name, now.unit};
                   value.before = kNoSuchValue;
                   value.after = now.value;
                   visit(value, false);
                 });
  }

  void judge(ValueChange value, bool both, RunComparison& result) const {
    const std::string metric = without_statistic(value.metric);
    if (in_one_only_.contains(metric) || (!both && !absent_is_a_loss_)) return;
    Gate gate = gates_.of(value.variant, value.metric);
    if (find_metric(topic_, metric) == nullptr) gate.direction = recorded_direction(metric);
    if (const auto why = unjudged_.find(value.variant); why != unjudged_.end()) {
      value.unjudged = why->second;
    } else if (!gate.compared) {
      value.unjudged = "does not repeat";
    }
    if (judge_change(gate, value)) {
      result.values.push_back(std::move(value));
    } else {
      ++result.within;
    }
  }

  [[nodiscard]] Direction recorded_direction(const std::string& metric) const {
    for (const Direction direction : {Direction::lower_is_better, Direction::higher_is_better}) {
      if (recorded_direction_.at(metric) == direction_text(direction)) return direction;
    }
    return Direction::none;  // also a target that the record does not have
  }

  const Sides& sides_;
  const Topic& topic_;
  Gates gates_;
  bool absent_is_a_loss_ = true;
  GatedValues before_, after_;
  std::map<std::string, std::string> unjudged_;  ///< by label
  std::map<std::string, std::string> recorded_direction_;
  std::set<std::string> in_one_only_;
};

/// Texts of claims about times, which decide nothing here.
std::set<std::string> timed_claims(const TomlNode& spec) {
  const auto text = [](const TomlNode& table, const char* key) {
    const TomlNode* node = table.find(key);
    return node == nullptr ? std::string() : node->text;
  };
  std::set<std::string> timed{"timing:"};
  for (const TomlNode& study : tables_of(spec, "study")) {
    if (text(study, "quantity").starts_with("timing:"))
      timed.insert("study:" + text(study, "name"));
  }
  std::set<std::string> texts;
  for (const TomlNode& claim : tables_of(spec, "claim")) {
    const std::string metric = text(claim, "metric");
    if (metric.starts_with("timing:") || timed.contains(metric)) texts.insert(text(claim, "text"));
  }
  return texts;
}

/// Better is less.
int rank_of(ClaimOutcome outcome) {
  return outcome == ClaimOutcome::holds ? 0 : outcome == ClaimOutcome::not_told_apart ? 1 : 2;
}

void compare_claim_outcomes(const Sides& sides, RunComparison& result) {
  const std::set<std::string> timed = timed_claims(sides.spec_after);
  for (const ClaimRecord& old : sides.before.claims) {
    const auto& all = sides.after.claims;
    const auto now = std::find_if(all.begin(), all.end(), [&](const ClaimRecord& claim) {
      return claim.text == old.text && claim.case_name == old.case_name;
    });
    if (now == all.end()) continue;
    const ClaimOutcome before = outcome_of(old), after = outcome_of(*now);
    if (before == after) {
      ++result.same_claims;
      continue;
    }
    ClaimChange change{Change::changed, now->text, now->case_name, text_of(before), text_of(after),
                       now->detail,     ""};
    if (timed.contains(now->text)) {
      change.unjudged = "time";
    } else if (!now->excepted.empty()) {
      change.unjudged = "excepted";
    } else {
      change.change = rank_of(after) > rank_of(before) ? Change::worse : Change::better;
    }
    result.claims.push_back(std::move(change));
  }
  std::stable_sort(result.claims.begin(), result.claims.end(),
                   [](const auto& a, const auto& b) { return a.change < b.change; });
}

using PairedTimes = std::pair<std::vector<double>, std::vector<double>>;

void add_if_timed(double before, double after, PairedTimes& times) {
  if (std::isnan(after) || !(before > 0)) return;
  times.first.push_back(before);
  times.second.push_back(after);
}

/// Times of equal frame and repetition; empty where there are none.
PairedTimes paired_times(const VariantPair& pair, const std::string& phase) {
  PairedTimes times;
  const auto& before = pair.before->timing.at(phase);
  const auto& after = pair.after->timing.at(phase);
  for (std::size_t i = 0; i < std::min(before.size(), pair.before->frames.size()); ++i) {
    const int same = frame_of_parameter(pair.after->frames, pair.before->frames[i].parameter);
    if (same < 0 || static_cast<std::size_t>(same) >= after.size()) continue;
    const std::vector<double>& row = after[static_cast<std::size_t>(same)];
    for (std::size_t r = 0; r < std::min(before[i].size(), row.size()); ++r) {
      add_if_timed(before[i][r], row[r], times);
    }
  }
  return times;
}

/// Times of whole runs over the same frames, where a program from outside has no times of frames;
/// else empty.
PairedTimes paired_runs(const VariantPair& pair) {
  const VariantRecord &a = *pair.before, &b = *pair.after;
  const bool from_outside = a.timing.contains(kWholeProcess) || b.timing.contains(kWholeProcess);
  const bool complete = a.status == "done" && b.status == "done" && same_frames(a.frames, b.frames);
  if (!from_outside || !complete) return {};
  const std::vector<double> before = whole_runs(a.timing), after = whole_runs(b.timing);
  PairedTimes times;
  for (std::size_t r = 0; r < std::min(before.size(), after.size()); ++r) {
    add_if_timed(before[r], after[r], times);
  }
  return times;
}

std::vector<TimeRatio> time_ratios(const std::vector<VariantPair>& pairs) {
  std::vector<TimeRatio> ratios;
  for (const VariantPair& pair : pairs) {
    const auto add = [&](const char* phase, const PairedTimes& times) {
      const auto& [before, after] = times;
      if (before.empty()) return;
      ratios.push_back({pair.case_before->name, pair.label, phase, median(before), median(after),
                        median_of_paired_ratios(after, before, pair.case_before->seed),
                        before.size()});
    };
    for (const char* phase : {"solve", "run"}) {
      if (!pair.before->timing.contains(phase) || !pair.after->timing.contains(phase)) continue;
      add(phase, paired_times(pair, phase));
    }
    add("whole run", paired_runs(pair));
  }
  std::stable_sort(ratios.begin(), ratios.end(), [](const TimeRatio& a, const TimeRatio& b) {
    return a.ratio.value > b.ratio.value;
  });
  return ratios;
}

/// Method and options in which the variants of a hand-made pair differ.
std::vector<KeyDifference> differing_options(const Sides& sides, const ComparisonRequest& request) {
  const auto table_of = [](const TomlNode& spec, const std::string& name) {
    for (const TomlNode& variant : tables_of(spec, "variant")) {
      const TomlNode* has = variant.find("name");
      if (has != nullptr && has->text == name) return variant;
    }
    return TomlNode();
  };
  std::vector<KeyDifference> all;
  for (const auto& [a, b] : request.variants) {
    for (KeyDifference& one :
         differing_members(table_of(sides.spec_before, a), table_of(sides.spec_after, b))) {
      if (one.key == "name") continue;
      if (request.variants.size() > 1) one.key = a + " → " + b + ": " + one.key;
      all.push_back(std::move(one));
    }
  }
  return all;
}

std::string processor_of(const RunRecord& record) {
  const auto found = record.provenance.find("cpu");
  return found == record.provenance.end() ? "unknown" : found->second;
}

}  // namespace

double ValueChange::tolerances() const {
  const double moved = std::abs(after - before);
  return std::isnan(moved) ? std::numeric_limits<double>::infinity() : moved / tolerance;
}

bool RunComparison::fell() const {
  const auto any = [](const auto& changes) {
    return std::any_of(changes.begin(), changes.end(),
                       [](const auto& one) { return is_fall(one.change); });
  };
  return any(values) || any(claims) || any(statuses) || !lost.empty();
}

std::size_t RunComparison::count(Change change) const {
  return static_cast<std::size_t>(std::count_if(
      values.begin(), values.end(), [&](const auto& value) { return value.change == change; }));
}

bool judge_change(const Gate& gate, ValueChange& value) {
  const double before = value.before, after = value.after;
  value.direction = gate.direction;
  value.target = gate.target;
  value.tolerance = std::isfinite(before) ? gate.tolerance.of(before) : gate.tolerance.absolute;
  value.change = Change::changed;
  const bool judged = value.unjudged.empty() && gate.direction != Direction::none;
  if (std::isnan(before) || std::isnan(after)) {
    if (judged && std::isnan(after)) value.change = Change::lost;
    return std::isnan(before) != std::isnan(after);
  }
  if (before == after || std::abs(after - before) <= value.tolerance) return false;
  const double worse = worsening(gate, after, before);
  if (judged && worse > value.tolerance) value.change = Change::worse;
  if (judged && -worse > value.tolerance) value.change = Change::better;
  return true;
}

RunComparison compare_runs(const OpenedRun& before, const OpenedRun& after, const Topic& topic,
                           const ComparisonRequest& request) {
  const std::string place = before.folder().string() + " and " + after.folder().string();
  if (before.record().topic != after.record().topic) {
    throw Error(
        "are runs of different topics, " + before.record().topic + " and " + after.record().topic,
        place, "two runs of one topic");
  }
  const Sides sides{before.record(), after.record(), recorded_specification(before),
                    recorded_specification(after)};
  RunComparison result;
  result.keys = differing_keys(sides.spec_before, sides.spec_after);
  if (!request.common) require_same_specification(result.keys, place);
  for (const auto& [a, b] : request.variants) {
    require_variant(sides.before, a, "first");
    require_variant(sides.after, b, "second");
  }
  result.options = differing_options(sides, request);
  result.inputs = differing_inputs(sides.before.inputs, sides.after.inputs);
  result.one_run = std::filesystem::equivalent(before.folder(), after.folder());
  result.same_bytes =
      request.variants.empty() && sides.before.content_sha256 == sides.after.content_sha256;
  std::vector<VariantPair> pairs = pairs_of(sides, request);
  if (pairs.empty()) throw Error("have no case with a common variant", place);
  if (request.variants.empty()) {
    result.only_before = missing_in(sides.after, sides.before);
    result.only_after = missing_in(sides.before, sides.after);
  }
  result.statuses = take_failures(pairs);
  ValueComparison(sides, topic, request).compare(pairs, result);
  compare_claim_outcomes(sides, result);
  result.times = time_ratios(pairs);
  result.same_processor = processor_of(sides.before) == processor_of(sides.after);
  return result;
}

}  // namespace geoprior
