#include "testbed/runner/reference/outcomes.h"

#include <algorithm>
#include <set>

#include "testbed/joined.h"
#include "testbed/runner/journal/content_hash.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/reference/headlines.h"

namespace geoprior {
namespace {

std::set<std::string> reference_metrics_of(const Topic& topic) {
  std::set<std::string> names;
  for (const MetricGroup& group : topic.metrics) {
    if (!group.needs_reference) continue;
    for (const MetricEntry& row : group.rows) names.insert(row.name);
  }
  return names;
}

bool repeats(const Topic& topic, const std::string& method) {
  return std::none_of(topic.methods.begin(), topic.methods.end(), [&](const MethodEntry& entry) {
    return entry.name == method && !entry.gated();
  });
}

const std::string* find_outcome(const Outcomes& outcomes, const std::string& in,
                                const std::string& variant) {
  const auto variants = outcomes.find(in);
  if (variants == outcomes.end()) return nullptr;
  const auto hash = variants->second.find(variant);
  return hash == variants->second.end() ? nullptr : &hash->second;
}

std::string column_text(const std::string& in, const std::string& variant) {
  return variant + " (" + in + ")";
}

/// visit(case, variant, hash) of each column.
template <class Visit>
void visit_columns(const Outcomes& outcomes, const Visit& visit) {
  for (const auto& [in, variants] : outcomes) {
    for (const auto& [variant, hash] : variants) visit(in, variant, hash);
  }
}

/// Columns that came to the same now and did not when they were blessed, a line each set of them.
void add_merged(const Outcomes& now, const Outcomes& blessed, std::vector<std::string>& failures) {
  struct Equal {
    std::vector<std::string> columns;
    std::set<std::string> before;
  };
  std::map<std::string, Equal> equal;
  visit_columns(now, [&](const auto& in, const auto& variant, const auto& hash) {
    const std::string* before = find_outcome(blessed, in, variant);
    if (before == nullptr) return;
    equal[hash].columns.push_back(column_text(in, variant));
    equal[hash].before.insert(*before);
  });
  for (const auto& [hash, one] : equal) {
    if (one.before.size() < 2) continue;
    failures.push_back("outcomes have become equal, an option has stopped to do anything: " +
                       joined(one.columns));
  }
}

}  // namespace

Outcomes outcomes_of(const RunRecord& record, const Topic& topic) {
  const std::set<std::string> compared = reference_metrics_of(topic);
  const auto counts = [&](const std::string& name) {
    return !compared.contains(name) && !compared.contains(without_statistic(name));
  };
  Outcomes outcomes;
  for (const CaseRecord& in : record.cases) {
    if (in.claims_only) continue;
    for (const VariantRecord& variant : in.variants) {
      if (!repeats(topic, variant.method)) continue;
      outcomes[in.name][variant.name] =
          sha256(outcome_text(variant, counts)).substr(0, kOutcomeDigits);
    }
  }
  return outcomes;
}

OutcomeDifference compare_outcomes(const Outcomes& now, const Outcomes& blessed) {
  OutcomeDifference difference;
  std::vector<std::string> others, added, gone;
  visit_columns(now, [&](const auto& in, const auto& variant, const auto& hash) {
    const std::string* before = find_outcome(blessed, in, variant);
    if (before != nullptr && *before == hash) return;
    (before == nullptr ? added : others).push_back(column_text(in, variant));
  });
  visit_columns(blessed, [&](const auto& in, const auto& variant, const auto&) {
    if (find_outcome(now, in, variant) == nullptr) gone.push_back(column_text(in, variant));
  });
  if (!others.empty())
    difference.notices.push_back("outcomes are not those blessed: " + joined(others));
  if (!added.empty())
    difference.notices.push_back("outcomes are new (bless to hold them): " + joined(added));
  if (!gone.empty())
    difference.failures.push_back("outcomes are gone (bless the rest to forget them): " +
                                  joined(gone));
  add_merged(now, blessed, difference.failures);
  return difference;
}

}  // namespace geoprior
