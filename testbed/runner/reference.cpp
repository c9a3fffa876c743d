#include "testbed/runner/reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/home.h"
#include "testbed/runner/number_text.h"

namespace geoprior {
namespace {

using Json = nlohmann::json;

constexpr int kSchemaVersion = 2;

/// "overlap_volume" of "overlap_volume.max": what has one unit in all of its reductions.
std::string base_name(const std::string& summary_name) {
  return summary_name.substr(0, summary_name.rfind('.'));
}

template <class Visit>
void for_each_value(const ReferenceSet& set, Visit visit) {
  for (const auto& [case_name, variants] : set) {
    for (const auto& [variant, metrics] : variants) {
      for (const auto& [metric, value] : metrics) visit(case_name, variant, metric, value);
    }
  }
}

/// What most values of a set share; a value says only what it has otherwise.
struct Shared {
  std::string reason;
  std::string commit;
  std::map<std::string, std::string> units;  ///< by `base_name`
};

Shared shared_by_most(const ReferenceSet& set) {
  Shared shared;
  std::map<std::pair<std::string, std::string>, std::size_t> blessings;
  for_each_value(set, [&](const auto&, const auto&, const auto& metric, const auto& value) {
    ++blessings[{value.reason, value.commit}];
    shared.units.emplace(base_name(metric), value.unit);
  });
  const auto most =
      std::max_element(blessings.begin(), blessings.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most != blessings.end()) std::tie(shared.reason, shared.commit) = most->first;
  return shared;
}

/// A plain number, or an object of what the value does not share.
Json json_of(const ReferenceValue& value, const std::string& unit, const Shared& shared) {
  const Json number =
      std::isfinite(value.value) ? Json(value.value) : Json(number_text(value.value));
  Json own = Json::object();
  if (value.unit != unit) own["unit"] = value.unit;
  if (value.reason != shared.reason) own["reason"] = value.reason;
  if (value.commit != shared.commit) own["commit"] = value.commit;
  if (own.empty()) return number;
  own["value"] = number;
  return own;
}

Json json_of(const ReferenceSet& set) {
  const Shared shared = shared_by_most(set);
  Json values = Json::object();
  for_each_value(set, [&](const auto& in, const auto& variant, const auto& metric, const auto& v) {
    values[in][variant][metric] = json_of(v, shared.units.at(base_name(metric)), shared);
  });
  return {{"reason", shared.reason},
          {"commit", shared.commit},
          {"units", shared.units},
          {"values", values}};
}

double number_of(const Json& value) {
  if (value.is_number()) return value.get<double>();
  const auto text = value.get<std::string>();
  if (text == "inf") return std::numeric_limits<double>::infinity();
  if (text == "-inf") return -std::numeric_limits<double>::infinity();
  if (text == "nan" || text == "-nan") return std::numeric_limits<double>::quiet_NaN();
  throw Error("'" + text + "' is no number", "value", "a number, \"nan\", \"inf\", \"-inf\"");
}

ReferenceValue value_of(const Json& entry, const std::string& unit, const Json& shared) {
  if (!entry.is_object()) return {number_of(entry), unit, shared.at("reason"), shared.at("commit")};
  const auto own = [&](const char* key) -> std::string {
    return entry.contains(key) ? entry.at(key) : shared.at(key);
  };
  return {number_of(entry.at("value")), entry.value("unit", unit), own("reason"), own("commit")};
}

ReferenceSet set_of(const Json& json) {
  ReferenceSet set;
  for (const auto& [case_name, variants] : json.at("values").items()) {
    for (const auto& [variant, metrics] : variants.items()) {
      for (const auto& [metric, entry] : metrics.items()) {
        const std::string unit = json.at("units").at(base_name(metric));
        set[case_name][variant][metric] = value_of(entry, unit, json);
      }
    }
  }
  return set;
}

bool within(double value, double reference, const Tolerance& tolerance) {
  if (std::isnan(value) || std::isnan(reference)) return std::isnan(value) == std::isnan(reference);
  if (value == reference) return true;  // infinities too
  return std::abs(value - reference) <=
         tolerance.absolute + tolerance.relative * std::abs(reference);
}

std::string change(const SummaryValue& now, double reference) {
  const double step = now.value - reference;
  const bool up = now.direction == "higher_is_better", down = now.direction == "lower_is_better";
  if (std::isnan(step) || (!up && !down)) return "changed";
  return (step > 0) == up ? "changed for the better (bless it to keep it)"
                          : "changed for the worse";
}

const ReferenceValue* find(const ReferenceSet& set, const std::string& case_name,
                           const std::string& variant, const std::string& metric) {
  const auto in_case = set.find(case_name);
  if (in_case == set.end()) return nullptr;
  const auto of_variant = in_case->second.find(variant);
  if (of_variant == in_case->second.end()) return nullptr;
  const auto value = of_variant->second.find(metric);
  return value == of_variant->second.end() ? nullptr : &value->second;
}

const SummaryValue* find(const RunRecord& record, const std::string& case_name,
                         const std::string& variant, const std::string& metric) {
  for (const CaseRecord& in : record.cases) {
    if (in.name != case_name) continue;
    for (const VariantRecord& v : in.variants) {
      if (v.name != variant) continue;
      const auto value = v.summary.find(metric);
      return value == v.summary.end() ? nullptr : &value->second;
    }
  }
  return nullptr;
}

}  // namespace

std::filesystem::path reference_file(const std::string& experiment_id) {
  return geoprior_home() / "results" / "reference" / (experiment_id + ".json");
}

Reference read_reference(const std::filesystem::path& file) {
  Reference reference;
  if (!std::filesystem::exists(file)) return reference;
  const std::string text = read_whole_file(file);
  try {
    const Json json = Json::parse(text);
    const int version = json.at("schema_version");
    if (version != kSchemaVersion) {
      throw Error("schema version " + std::to_string(version), file.string(),
                  std::to_string(kSchemaVersion));
    }
    for (const char* size : {"full", "quick"}) {
      if (json.contains(size)) reference.sets[size] = set_of(json.at(size));
    }
  } catch (const Json::exception& error) {
    throw Error(std::string("is damaged: ") + error.what(), file.string(),
                "what `geoprior bless` writes");
  }
  return reference;
}

void write_reference(const Reference& reference, const std::filesystem::path& file) {
  Json json;
  json["schema_version"] = kSchemaVersion;
  for (const auto& [size, set] : reference.sets) json[size] = json_of(set);
  make_folders(file.parent_path());
  write_file_atomically(file, std::string_view(json.dump(1) + "\n"));
}

ToleranceOf tolerances_of(const Experiment& experiment, const Topic& topic) {
  std::map<std::string, Tolerance> tolerances;
  for (const MetricEntry& metric : metric_rows(topic)) tolerances[metric.name] = metric.tolerance;
  for (const auto& [metric, tolerance] : experiment.tolerances) tolerances[metric] = tolerance;
  return [tolerances](const std::string& name) {
    auto found = tolerances.find(name);
    if (found == tolerances.end()) found = tolerances.find(name.substr(0, name.rfind('.')));
    return found == tolerances.end() ? Tolerance{} : found->second;
  };
}

std::vector<Mismatch> compare_with_reference(const RunRecord& record, const ReferenceSet& reference,
                                             const ToleranceOf& tolerance_of) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<Mismatch> mismatches;
  for (const CaseRecord& in : record.cases) {
    for (const VariantRecord& variant : in.variants) {
      for (const auto& [metric, now] : variant.summary) {
        const ReferenceValue* before = find(reference, in.name, variant.name, metric);
        Mismatch mismatch{in.name, variant.name, metric, "", now.value, kNone, 0, now.unit};
        if (before == nullptr) {
          mismatch.problem = "has no reference value (bless it)";
          mismatches.push_back(mismatch);
          continue;
        }
        const Tolerance tolerance = tolerance_of(metric);
        mismatch.reference = before->value;
        mismatch.tolerance = tolerance.absolute + tolerance.relative * std::abs(before->value);
        if (before->unit != now.unit) {
          mismatch.problem = "unit was " + before->unit;
        } else if (!within(now.value, before->value, tolerance)) {
          mismatch.problem = change(now, before->value);
        }
        if (!mismatch.problem.empty()) mismatches.push_back(mismatch);
      }
    }
  }
  for (const auto& [case_name, variants] : reference) {
    for (const auto& [variant, metrics] : variants) {
      for (const auto& [metric, before] : metrics) {
        if (find(record, case_name, variant, metric) != nullptr) continue;
        mismatches.push_back({case_name, variant, metric, "is gone (bless the rest to forget it)",
                              kNone, before.value, 0, before.unit});
      }
    }
  }
  return mismatches;
}

ReferenceSet bless_values(const RunRecord& record, const ReferenceSet& before,
                          const std::string& reason, const std::string& commit) {
  ReferenceSet set;
  for (const CaseRecord& in : record.cases) {
    for (const VariantRecord& variant : in.variants) {
      for (const auto& [metric, now] : variant.summary) {
        const ReferenceValue* old = find(before, in.name, variant.name, metric);
        const bool same =
            old != nullptr && old->unit == now.unit &&
            (old->value == now.value || (std::isnan(old->value) && std::isnan(now.value)));
        set[in.name][variant.name][metric] =
            same ? *old : ReferenceValue{now.value, now.unit, reason, commit};
      }
    }
  }
  return set;
}

std::string mismatch_text(const std::string& experiment_id, const Mismatch& m) {
  const std::string unit = m.unit.empty() || m.unit == "1" ? "" : " " + m.unit;
  return experiment_id + ", case '" + m.case_name + "', variant '" + m.variant + "', metric '" +
         m.metric + "' " + m.problem + ": value " + number_text(m.value) + unit + ", reference " +
         number_text(m.reference) + unit + ", tolerance " + rounded_text(m.tolerance) + unit;
}

}  // namespace geoprior
