#include "testbed/runner/judgement/measure.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "testbed/metric_rows.h"
#include "testbed/runner/judgement/timing_statistics.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/options/quantity.h"

namespace geoprior {

namespace {

std::string rows_text(const MetricGroup& group) {
  std::string names;
  for (const MetricEntry& row : group.rows) {
    names += (names.empty() ? "'" : ", '") + row.name + "'";
  }
  return (group.rows.size() == 1 ? "metric " : "metrics ") + names;
}

/// Adds what `measure` gives of a group to the values.
template <class Measure>
void add_values(const MetricGroup& group, const std::string& where, const Measure& measure,
                std::map<std::string, double>& values) {
  try {
    const MetricValues measured = measure();
    for (std::size_t i = 0; i < group.rows.size(); ++i) {
      if (measured.at(i)) values[group.rows[i].name] = *measured[i];
    }
  } catch (const MetricRowError& error) {
    throw Error(error.what(), "metric '" + error.row() + "'" + where);
  } catch (const Error& error) {
    throw Error(error.what(), rows_text(group) + where);
  }
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

std::map<std::string, double> measure_frame(const MetricGroup& group, const Scene& scene,
                                            const Frame& frame, const Frame* reference) {
  std::map<std::string, double> values;
  if (!group.of_frame || (group.needs_reference && reference == nullptr)) return values;
  const std::string where = " at parameter " + number_text(frame.parameter);
  add_values(
      group, where, [&] { return group.of_frame(scene, frame, reference); }, values);
  return values;
}

std::map<std::string, double> measure_frame(const Topic& topic, const Scene& scene,
                                            const Frame& frame, const Frame* reference) {
  std::map<std::string, double> values;
  for (const MetricGroup& group : topic.metrics) {
    values.merge(measure_frame(group, scene, frame, reference));
  }
  return values;
}

std::map<std::string, double> measure_sequence(const MetricGroup& group, const Scene& scene,
                                               const FrameSequence& frames) {
  std::map<std::string, double> values;
  if (!group.of_sequence) return values;
  add_values(
      group, "", [&] { return group.of_sequence(scene, frames); }, values);
  return values;
}

std::map<std::string, double> measure_sequence(const Topic& topic, const Scene& scene,
                                               const FrameSequence& frames) {
  std::map<std::string, double> values;
  for (const MetricGroup& group : topic.metrics) {
    values.merge(measure_sequence(group, scene, frames));
  }
  return values;
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
                     [](const MetricGroup& group) { return bool(group.of_sequence); });
}

bool has_reference_metrics(const Topic& topic) {
  return std::any_of(topic.metrics.begin(), topic.metrics.end(),
                     [](const MetricGroup& group) { return group.needs_reference; });
}

std::optional<std::set<std::string>> reference_parts(const Topic& topic) {
  std::set<std::string> parts;
  for (const MetricGroup& group : topic.metrics) {
    if (!group.needs_reference) continue;
    if (group.reference_parts.empty()) return std::nullopt;
    parts.insert(group.reference_parts.begin(), group.reference_parts.end());
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
