#include "testbed/topic.h"

namespace geoprior {

std::vector<std::reference_wrapper<const MetricEntry>> metric_rows(const Topic& topic) {
  std::vector<std::reference_wrapper<const MetricEntry>> rows;
  for (const MetricGroup& group : topic.metrics) {
    rows.insert(rows.end(), group.rows.begin(), group.rows.end());
  }
  return rows;
}

const MetricEntry* find_metric(const Topic& topic, const std::string& name) {
  for (const MetricEntry& row : metric_rows(topic)) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

}  // namespace geoprior
