#include "testbed/runner/measure.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/quantity.h"
#include "testbed/runner/timing_statistics.h"

namespace geoprior {

namespace {

const MetricEntry* find_metric(const Topic& topic, const std::string& name) {
  for (const MetricEntry& metric : topic.metrics) {
    if (metric.name == name) return &metric;
  }
  return nullptr;
}

const DiagnosticEntry* find_diagnostic(const Topic& topic, const std::string& name) {
  for (const DiagnosticEntry& diagnostic : topic.diagnostics) {
    if (diagnostic.name == name) return &diagnostic;
  }
  return nullptr;
}

template <class Of>
std::map<std::string, double> values_of(const Topic& topic, const std::string& where, Of of) {
  std::map<std::string, double> values;
  for (const MetricEntry& metric : topic.metrics) {
    try {
      if (const std::optional<double> value = of(metric)) values[metric.name] = *value;
    } catch (const Error& error) {
      throw Error(error.what(), "metric '" + metric.name + "'" + where);
    }
  }
  return values;
}

void summarise_column(const std::string& name, const MetricColumn& column, VariantRecord& variant) {
  std::vector<double> values;
  std::copy_if(column.values.begin(), column.values.end(), std::back_inserter(values),
               [](double x) { return !std::isnan(x); });
  if (values.empty()) return;
  const auto put = [&](const char* which, const char* of, double value) {
    variant.summary[name + which] = {value, column.unit, of + column.definition, column.direction};
  };
  put(".max", "Largest over the frames. ", *std::max_element(values.begin(), values.end()));
  put(".min", "Smallest over the frames. ", *std::min_element(values.begin(), values.end()));
  put(".median", "Median over the frames. ", median(values));
  put(".last", "At the last frame that has a value. ", values.back());
}

}  // namespace

std::string direction_text(Direction direction) {
  switch (direction) {
    case Direction::lower_is_better:
      return "lower_is_better";
    case Direction::higher_is_better:
      return "higher_is_better";
    case Direction::closer_to_target:
      return "closer_to_target";
    case Direction::none:
      break;
  }
  return "none";
}

int frame_of_parameter(const std::vector<FrameRecord>& frames, double parameter) {
  const auto matches = [&](const FrameRecord& frame) {
    return same_parameter(frame.parameter, parameter);
  };
  const auto found = std::find_if(frames.begin(), frames.end(), matches);
  return found == frames.end() ? -1 : static_cast<int>(found - frames.begin());
}

std::map<std::string, double> measure_frame(const Topic& topic, const Scene& scene,
                                            const Frame& frame, const Frame* reference) {
  return values_of(topic, " at parameter " + number_text(frame.parameter),
                   [&](const MetricEntry& metric) -> std::optional<double> {
                     if (!metric.of_frame) return std::nullopt;
                     if (metric.needs_reference && reference == nullptr) return std::nullopt;
                     return metric.of_frame(scene, frame, reference);
                   });
}

std::map<std::string, double> measure_sequence(const Topic& topic, const Scene& scene,
                                               const FrameSequence& frames) {
  return values_of(topic, "", [&](const MetricEntry& metric) -> std::optional<double> {
    if (!metric.of_sequence) return std::nullopt;
    return metric.of_sequence(scene, frames);
  });
}

void require_declared(const Topic& topic, const Frame& frame, const std::string& method) {
  for (const auto& [name, value] : frame.diagnostics) {
    if (find_diagnostic(topic, name) != nullptr) continue;
    std::string declared;
    for (const DiagnosticEntry& entry : topic.diagnostics) {
      declared += (declared.empty() ? "" : ", ") + entry.name;
    }
    throw Error("method '" + method + "' has a diagnostic '" + name + "' without unit and meaning",
                "table of diagnostics of topic '" + topic.name + "'", declared);
  }
}

bool has_sequence_metrics(const Topic& topic) {
  return std::any_of(topic.metrics.begin(), topic.metrics.end(),
                     [](const MetricEntry& metric) { return bool(metric.of_sequence); });
}

bool has_reference_metrics(const Topic& topic) {
  return std::any_of(topic.metrics.begin(), topic.metrics.end(),
                     [](const MetricEntry& metric) { return metric.needs_reference; });
}

std::optional<std::set<std::string>> reference_parts(const Topic& topic) {
  std::set<std::string> parts;
  for (const MetricEntry& metric : topic.metrics) {
    if (!metric.needs_reference) continue;
    if (metric.reference_parts.empty()) return std::nullopt;
    parts.insert(metric.reference_parts.begin(), metric.reference_parts.end());
  }
  return parts;
}

void summarise(const Topic& topic, VariantRecord& variant) {
  const auto describe_column = [&](const std::string& name, auto& column) {
    if (const MetricEntry* metric = find_metric(topic, name)) {
      column.unit = metric->unit;
      column.definition = metric->definition;
      column.direction = direction_text(metric->direction);
    }
  };
  for (auto& [name, value] : variant.summary) describe_column(name, value);
  for (auto& [name, column] : variant.metrics) {
    describe_column(name, column);
    summarise_column(name, column, variant);
  }
  for (auto& [name, column] : variant.diagnostics) {
    if (const DiagnosticEntry* diagnostic = find_diagnostic(topic, name)) {
      column.unit = diagnostic->unit;
      column.definition = diagnostic->definition;
    }
  }
}

}  // namespace geoprior
