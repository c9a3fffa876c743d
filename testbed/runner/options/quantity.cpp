#include "testbed/runner/options/quantity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "testbed/runner/judgement/timing_statistics.h"
#include "testbed/runner/number_text.h"

namespace geoprior {
namespace {

std::string place(const CaseRecord& in, const VariantRecord& variant) {
  return "case '" + in.name + "', variant '" + variant.name + "'";
}

template <class Map>
std::string key_list(const Map& map) {
  std::string text;
  for (const auto& [key, value] : map) text += (text.empty() ? "" : ", ") + key;
  return text.empty() ? "none there" : text;
}

std::size_t frame_at(const CaseRecord& in, const VariantRecord& variant, double parameter) {
  std::string parameters;
  for (std::size_t i = 0; i < variant.frames.size(); ++i) {
    if (same_parameter(variant.frames[i].parameter, parameter)) return i;
    parameters += (i == 0 ? "" : ", ") + rounded_text(variant.frames[i].parameter, 6);
  }
  throw Error("there is no frame at " + in.parameter_name + " " + number_text(parameter) + " " +
                  in.parameter_unit,
              place(in, variant), parameters);
}

/// One value a frame; one value for all when the phase is timed as a whole.
std::vector<double> timing_values(const VariantRecord& variant, const std::string& phase,
                                  const std::string& where) {
  const auto found = variant.timing.find(phase);
  if (found == variant.timing.end()) {
    throw Error("phase '" + phase + "' was not timed", where, key_list(variant.timing));
  }
  std::vector<double> values;
  for (const std::vector<double>& repetitions : found->second)
    values.push_back(median(repetitions));
  return values;
}

/// The values of a quantity, one a frame or one for all.
struct Column {
  std::string unit;
  std::vector<double> values;
  bool of_sequence = false;
};

Column column_of(const CaseRecord& in, const VariantRecord& variant, const std::string& name) {
  const std::string where = place(in, variant);
  if (name.starts_with("timing:"))
    return {"s", timing_values(variant, name.substr(7), where), false};
  if (name.starts_with("diagnostic:")) {
    const auto found = variant.diagnostics.find(name.substr(11));
    if (found != variant.diagnostics.end())
      return {found->second.unit, found->second.values, false};
    throw Error("there is no diagnostic '" + name.substr(11) + "'", where,
                key_list(variant.diagnostics));
  }
  if (const auto found = variant.metrics.find(name); found != variant.metrics.end()) {
    return {found->second.unit, found->second.values, false};
  }
  if (const auto found = variant.summary.find(name); found != variant.summary.end()) {
    return {found->second.unit, {found->second.value}, true};
  }
  throw Error("metric '" + name + "' was not measured", where, key_list(variant.metrics));
}

}  // namespace

double reduced(std::vector<double> values, Reduction how) {
  std::erase_if(values, [](double x) { return std::isnan(x); });
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto sum = [&] { return std::accumulate(values.begin(), values.end(), 0.0); };
  switch (how) {
    case Reduction::max:
      return *std::max_element(values.begin(), values.end());
    case Reduction::min:
      return *std::min_element(values.begin(), values.end());
    case Reduction::median:
      return median(values);
    case Reduction::p95:
      return quantile(values, 0.95);
    case Reduction::p99:
      return quantile(values, 0.99);
    case Reduction::mean:
      return sum() / static_cast<double>(values.size());
    case Reduction::sum:
      return sum();
    case Reduction::last:
      return values.back();
    case Reduction::every:
      break;
  }
  throw Error("is no number", "reduce = \"every\"", "a claim that is decided frame by frame");
}

bool same_parameter(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});
}

Quantity quantity_of(const CaseRecord& in, const VariantRecord& variant, const std::string& name,
                     std::optional<double> at_parameter, Reduction reduce) {
  const Column column = column_of(in, variant, name);
  if (column.of_sequence && at_parameter) {
    throw Error("metric '" + name + "' has one value for all frames", place(in, variant),
                "no `at`, no reduction");
  }
  Quantity quantity{std::numeric_limits<double>::quiet_NaN(), column.unit};
  if (at_parameter) {
    const std::size_t frame = frame_at(in, variant, *at_parameter);
    if (frame < column.values.size()) quantity.value = column.values[frame];
  } else {
    quantity.value = reduced(column.values, reduce);
  }
  if (std::isnan(quantity.value)) {
    throw Error("'" + name + "' has no value", place(in, variant));
  }
  return quantity;
}

std::optional<double> value_at(const CaseRecord& in, const VariantRecord& variant,
                               const std::string& name, double parameter) {
  const Column column = column_of(in, variant, name);
  if (column.of_sequence) {
    throw Error("metric '" + name + "' has one value for all frames", place(in, variant),
                "no `at`, no reduction");
  }
  for (std::size_t i = 0; i < std::min(variant.frames.size(), column.values.size()); ++i) {
    const bool here = same_parameter(variant.frames[i].parameter, parameter);
    if (here && !std::isnan(column.values[i])) return column.values[i];
  }
  return std::nullopt;
}

}  // namespace geoprior
