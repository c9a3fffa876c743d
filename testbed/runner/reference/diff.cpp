#include "testbed/runner/reference/diff.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "testbed/runner/number_text.h"
#include "testbed/runner/reference/headlines.h"

namespace geoprior {
namespace {

using Kind = ReferenceChange::Kind;

bool differ(const ReferenceValue& a, const ReferenceValue& b) {
  if (a.unit != b.unit) return true;
  return std::isnan(a.value) || std::isnan(b.value) ? std::isnan(a.value) != std::isnan(b.value)
                                                    : a.value != b.value;
}

/// NaN where a side has no value.
double in_tolerances(const Gate& gate, double before, double after) {
  return std::abs(after - before) / gate.tolerance.of(before);
}

/// Changes that no number measures come first.
double rank(const ReferenceChange& change) {
  return std::isnan(change.tolerances) ? std::numeric_limits<double>::infinity()
                                       : change.tolerances;
}

std::string line_of(const ReferenceChange& change) {
  std::string text = change.metric;
  if (!change.variant.empty()) text += ", " + change.variant;
  if (!change.case_name.empty()) text += ", " + change.case_name;
  text += ": " + number_text(change.before) + " -> " + number_text(change.after);
  if (change.unit != "1") text += " " + change.unit;
  return text + " (" + rounded_text(change.tolerances, 3) + " tolerances)";
}

/// "312 more: overlap_excess.max 100, …"; empty when there are none.
std::string count_line(const std::map<std::string, std::size_t>& metrics, const std::string& what) {
  std::size_t total = 0;
  std::string list;
  for (const auto& [metric, count] : metrics) {
    total += count;
    list += (list.empty() ? "" : ", ") + metric + " " + std::to_string(count);
  }
  return total == 0 ? "" : std::to_string(total) + " " + what + ": " + list;
}

}  // namespace

std::vector<ReferenceChange> changes_of(const ReferenceSet& before, const ReferenceSet& after,
                                        const Gates& gates) {
  std::vector<ReferenceChange> changes;
  visit_values(after, [&](const auto& in, const auto& variant, const auto& name, const auto& v) {
    ReferenceChange change{Kind::added, in, variant, name, v.unit};
    change.after = v.value;
    if (const ReferenceValue* old = find_value(before, in, variant, name)) {
      if (!differ(*old, v)) return;
      change.kind = Kind::moved;
      change.before = old->value;
      change.tolerances = in_tolerances(gates.of(variant, name), old->value, v.value);
    }
    changes.push_back(change);
  });
  visit_values(before, [&](const auto& in, const auto& variant, const auto& name, const auto& v) {
    if (find_value(after, in, variant, name) != nullptr) return;
    ReferenceChange change{Kind::removed, in, variant, name, v.unit};
    change.before = v.value;
    changes.push_back(change);
  });
  std::stable_sort(changes.begin(), changes.end(), [](const auto& a, const auto& b) {
    return a.kind != b.kind ? a.kind < b.kind : rank(a) > rank(b);
  });
  return changes;
}

std::vector<std::string> difference_lines(const std::vector<ReferenceChange>& changes,
                                          std::size_t most) {
  std::vector<std::string> lines;
  std::map<std::string, std::size_t> more, added, removed;
  for (const ReferenceChange& change : changes) {
    if (change.kind == Kind::moved && lines.size() < most) {
      lines.push_back(line_of(change));
      continue;
    }
    auto& counts = change.kind == Kind::moved ? more : change.kind == Kind::added ? added : removed;
    ++counts[without_statistic(change.metric)];
  }
  for (const std::string& line :
       {count_line(more, "more moved"), count_line(added, "new"), count_line(removed, "gone")}) {
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

}  // namespace geoprior
