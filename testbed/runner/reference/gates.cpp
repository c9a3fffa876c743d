#include "testbed/runner/reference/gates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "testbed/runner/judgement/studies.h"
#include "testbed/runner/judgement/timing_statistics.h"
#include "testbed/runner/reference/headlines.h"

namespace geoprior {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kHeadlineShare = 0.03;
/// Of slopes, which claims hold against theory to 0.2.
constexpr Tolerance kSlope{0.02, 0};
/// Of a distance of two medians in half ranges, which a single seed can move.
constexpr Tolerance kWithinSpread{0.1, 0.05};

/// How far the left side is from where the claim would hold.
double shortfall(const ClaimSpec& claim, const ClaimRecord& record) {
  switch (direction_of(claim.is)) {
    case Direction::lower_is_better:
      return record.left - record.right;
    case Direction::higher_is_better:
      return record.right - record.left;
    default:
      return std::abs(record.left - record.right) - claim.tolerance;
  }
}

std::string unit_of(const Topic& topic, const std::string& quantity) {
  if (const MetricEntry* metric = find_metric(topic, quantity)) return metric->unit;
  if (!quantity.starts_with("diagnostic:")) return "1";
  const DiagnosticEntry* diagnostic = find_diagnostic(topic, quantity.substr(11));
  return diagnostic == nullptr ? "1" : diagnostic->unit;
}

std::string unit_of(const Topic& topic, const StudySpec& study) {
  const bool of_quantity = study.kind == StudyKind::spread || study.kind == StudyKind::pooled;
  return of_quantity ? unit_of(topic, study.quantity) : "1";
}

void add_counted_work(const Topic& topic, const VariantRecord& variant,
                      std::map<std::string, GatedValue>& values) {
  for (const DiagnosticEntry& entry : topic.diagnostics) {
    const auto column = variant.diagnostics.find(entry.name);
    if (!entry.counted_work || column == variant.diagnostics.end()) continue;
    std::vector<double> counts = column->second.values;
    std::erase_if(counts, [](double x) { return std::isnan(x); });
    if (counts.empty()) continue;
    const double sum = std::accumulate(counts.begin(), counts.end(), 0.0);
    values["diagnostic:" + entry.name] = {sum / static_cast<double>(counts.size()), entry.unit};
  }
}

}  // namespace

bool has_gated_method(const Topic& topic, const VariantRecord& variant) {
  const auto method =
      std::find_if(topic.methods.begin(), topic.methods.end(),
                   [&](const MethodEntry& entry) { return entry.name == variant.method; });
  return method == topic.methods.end() || method->gated();
}

namespace {

GatedValues values_of_cases(const Topic& topic, const std::vector<Headline>& headlines,
                            const RunRecord& record) {
  GatedValues all;
  for (const CaseRecord& in : record.cases) {
    if (in.claims_only) continue;
    for (const VariantRecord& variant : in.variants) {
      if (is_null_control(variant.role) || !has_gated_method(topic, variant)) continue;
      std::map<std::string, GatedValue>& values = all[in.name][variant.name];
      for (const Headline& headline : headlines) {
        if (const auto value = headline_value(in, variant, headline)) {
          values[headline.name()] = {*value, unit_of(topic, headline.metric)};
        }
      }
      add_counted_work(topic, variant, values);
    }
  }
  return all;
}

void add_shortfalls(const Experiment& experiment, const Topic& topic,
                    const std::vector<ClaimRecord>& claims, GatedValues& values) {
  for (const ClaimSpec& claim : experiment.claims) {
    if (!claim.known_shortfall) continue;
    const StudySpec* study = study_of(claim, experiment.studies);
    const std::string unit =
        study != nullptr ? unit_of(topic, *study) : unit_of(topic, claim.metric);
    for (const ClaimRecord& record : claims) {
      if (record.text != claim.text || record.holds) continue;
      const double size = std::abs(record.left) + (claim.of ? std::abs(record.right) : 0);
      values[record.case_name][""]["shortfall:" + claim.text] = {shortfall(claim, record), unit,
                                                                 size};
    }
  }
}

/// "seed=*", after the other values that were swept.
std::string name_over_seeds(const CaseRecord& in) {
  std::string name;
  for (const auto& [key, value] : in.swept) {
    if (key != "seed") name += key.substr(key.rfind('.') + 1) + "=" + value + ",";
  }
  return name + "seed=*";
}

}  // namespace

GatedValues medians_over_seeds(const RunRecord& record, const GatedValues& values) {
  struct Sample {
    std::string unit;
    std::optional<double> size;
    std::vector<double> values;
  };
  std::map<std::string, std::map<std::string, std::map<std::string, Sample>>> samples;
  GatedValues medians = values;
  for (const CaseRecord& in : record.cases) {
    if (!in.swept.contains("seed") || !values.contains(in.name)) continue;
    for (const auto& [variant, named] : values.at(in.name)) {
      for (const auto& [name, value] : named) {
        Sample& sample = samples[name_over_seeds(in)][variant][name];
        sample.unit = value.unit;
        sample.size = value.size;
        if (!std::isnan(value.value)) sample.values.push_back(value.value);
      }
    }
    medians.erase(in.name);
  }
  for (const auto& [in, variants] : samples) {
    for (const auto& [variant, named] : variants) {
      for (const auto& [name, sample] : named) {
        const double value = sample.values.empty() ? kNone : median(sample.values);
        medians[in][variant][name] = {value, sample.unit, sample.size};
      }
    }
  }
  return medians;
}

Gates::Gates(const Experiment& experiment, const Topic& topic) {
  for (const MetricEntry& metric : metric_rows(topic)) {
    Gate& gate = gates_[metric.name];
    gate.tolerance = metric.tolerance;
    gate.direction = metric.direction;
    gate.target = metric.target;
    gate.compared = metric.gated();
  }
  for (const DiagnosticEntry& entry : topic.diagnostics) {
    Gate& gate = gates_["diagnostic:" + entry.name];
    gate.tolerance = entry.tolerance;
    gate.direction = Direction::lower_is_better;
    gate.only_more = entry.counted_work;
  }
  for (const StudySpec& study : experiment.studies) gates_["study:" + study.name] = of_study(study);
  for (const auto& [name, tolerance] : experiment.tolerances) gates_[name].tolerance = tolerance;
  for (const ClaimSpec& claim : experiment.claims) add_claim(claim, experiment);
}

Tolerance Gates::of_quantity(const std::string& name) const {
  const auto gate = gates_.find(name);
  return gate == gates_.end() ? Tolerance{} : gate->second.tolerance;
}

Gate Gates::of_study(const StudySpec& study) const {
  Gate gate;
  switch (study.kind) {
    case StudyKind::exponent:
    case StudyKind::order:
    case StudyKind::range:
    case StudyKind::matched:
      gate.tolerance = kSlope;
      break;
    case StudyKind::spread:
    case StudyKind::pooled:
      gate.tolerance = of_quantity(study.quantity);
      break;
    case StudyKind::within_spread:
      gate.tolerance = kWithinSpread;
      break;
  }
  return gate;
}

void Gates::add_claim(const ClaimSpec& claim, const Experiment& experiment) {
  if (claim.known_shortfall) {
    Gate& gate = gates_["shortfall:" + claim.text];
    gate.tolerance = of_quantity(claim.metric);
    gate.direction = Direction::lower_is_better;
    if (claim.of) {
      // Either side may be off by the metric's tolerance.
      gate.tolerance.absolute *= 1 + std::abs(claim.factor);
    }
  }
  const StudySpec* study = study_of(claim, experiment.studies);
  if (study == nullptr) {
    headline_.emplace(claim.variant, claim.metric);
    return;
  }
  gates_[claim.metric].direction = direction_of(claim.is);
  headline_.emplace("", claim.metric);
  headline_.emplace(study->variant, study->quantity);
}

Gate Gates::of(const std::string& variant, const std::string& name) const {
  auto found = gates_.find(name);
  if (found == gates_.end()) found = gates_.find(without_statistic(name));
  if (found == gates_.end()) return {};
  Gate gate = found->second;
  gate.headline = !gate.only_more && headline_.contains({variant, found->first});
  return gate;
}

GatedValues gated_values(const Experiment& experiment, const Topic& topic, const RunRecord& record,
                         const std::vector<ClaimRecord>& claims) {
  GatedValues values = values_of_cases(topic, headlines(experiment, topic), record);
  add_shortfalls(experiment, topic, claims, values);
  if (experiment.bifurcates) values = medians_over_seeds(record, values);
  const std::vector<StudyRecord> studies =
      record.studies.empty() ? make_studies(experiment, record) : record.studies;
  for (const StudySpec& spec : experiment.studies) {
    const auto study = std::find_if(studies.begin(), studies.end(),
                                    [&](const StudyRecord& s) { return s.name == spec.name; });
    if (study == studies.end()) throw Error("is not in the run", "study '" + spec.name + "'");
    if (std::isnan(study->value)) continue;  // pooled events that have no such value
    values[""][""]["study:" + spec.name] = {study->value, unit_of(topic, spec)};
  }
  return values;
}

double headline_limit(const Gate& gate, double reference) {
  return std::max(kHeadlineShare * std::abs(reference), 2 * gate.tolerance.absolute);
}

double worsening(const Gate& gate, double value, double reference) {
  switch (gate.direction) {
    case Direction::lower_is_better:
      return value - reference;
    case Direction::higher_is_better:
      return reference - value;
    case Direction::closer_to_target:
      return std::abs(value - gate.target) - std::abs(reference - gate.target);
    case Direction::none:
      break;
  }
  return std::abs(value - reference);
}

}  // namespace geoprior
