#include "testbed/topic.h"

#include <utility>

#include "core/error.h"

namespace geoprior {

std::vector<std::reference_wrapper<const MetricEntry>> metric_rows(const Topic& topic) {
  std::vector<std::reference_wrapper<const MetricEntry>> rows;
  for (const MetricGroup& group : topic.metrics) {
    rows.insert(rows.end(), group.rows.begin(), group.rows.end());
  }
  return rows;
}

std::vector<std::string> metric_names(const Topic& topic) {
  std::vector<std::string> names;
  for (const MetricEntry& metric : metric_rows(topic)) names.push_back(metric.name);
  return names;
}

const MetricGroup& group_of(const Topic& topic, const MetricEntry& row) {
  for (const MetricGroup& group : topic.metrics) {
    for (const MetricEntry& of_group : group.rows) {
      if (&of_group == &row) return group;
    }
  }
  throw Error("is in no group", "metric '" + row.name + "'");
}

const MethodEntry& method_of(const Topic& topic, const std::string& name) {
  std::string allowed;
  for (const MethodEntry& entry : topic.methods) {
    if (entry.name == name) return entry;
    allowed += (allowed.empty() ? "" : ", ") + entry.name;
  }
  throw Error("unknown method '" + name + "'", "topic '" + topic.name + "'", allowed);
}

const MetricEntry* find_metric(const Topic& topic, const std::string& name) {
  for (const MetricEntry& row : metric_rows(topic)) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

const DiagnosticEntry* find_diagnostic(const Topic& topic, const std::string& name) {
  for (const DiagnosticEntry& row : topic.diagnostics) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

void DiagnosticTable::measured(std::string metric, DiagnosticEntry row) {
  row.metric = std::move(metric);
  rows_.push_back(std::move(row));
}

void DiagnosticTable::unmeasured(const std::string& why, std::vector<DiagnosticEntry> rows) {
  for (DiagnosticEntry& row : rows) {
    row.unmeasured = why;
    rows_.push_back(std::move(row));
  }
}

}  // namespace geoprior
