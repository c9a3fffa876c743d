#include "experiments/runner/reference.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "experiments/formats/atomic_file.h"
#include "experiments/runner/number_text.h"
#include "experiments/view/view.h"

namespace geoprior {
namespace {

using Json = nlohmann::json;

constexpr int kSchemaVersion = 1;

Json json_of(const ReferenceSet& set) {
  Json json = Json::object();
  for (const auto& [case_name, variants] : set) {
    for (const auto& [variant, metrics] : variants) {
      for (const auto& [metric, value] : metrics) {
        Json& entry = json[case_name][variant][metric];
        if (std::isfinite(value.value))
          entry["value"] = value.value;
        else
          entry["value"] = number_text(value.value);
        entry["unit"] = value.unit;
        entry["reason"] = value.reason;
        entry["commit"] = value.commit;
      }
    }
  }
  return json;
}

double number_of(const Json& value) {
  if (value.is_number()) return value.get<double>();
  const auto text = value.get<std::string>();
  if (text == "inf") return std::numeric_limits<double>::infinity();
  if (text == "-inf") return -std::numeric_limits<double>::infinity();
  if (text == "nan" || text == "-nan") return std::numeric_limits<double>::quiet_NaN();
  throw Error("'" + text + "' is no number", "value", "a number, \"nan\", \"inf\", \"-inf\"");
}

ReferenceSet set_of(const Json& json) {
  ReferenceSet set;
  for (const auto& [case_name, variants] : json.items()) {
    for (const auto& [variant, metrics] : variants.items()) {
      for (const auto& [metric, entry] : metrics.items()) {
        set[case_name][variant][metric] = {number_of(entry.at("value")), entry.at("unit"),
                                           entry.at("reason"), entry.at("commit")};
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
  for (const MetricEntry& metric : topic.metrics) tolerances[metric.name] = metric.tolerance;
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
