#include "testbed/runner/reference/headlines.h"

#include <algorithm>
#include <limits>

#include "testbed/runner/number_text.h"
#include "testbed/runner/options/quantity.h"

namespace geoprior {
namespace {

constexpr double kNoHeadline = std::numeric_limits<double>::quiet_NaN();

/// Collects headlines, each once.
class Headlines {
 public:
  explicit Headlines(const Topic& topic) : topic_(topic) {}

  void add(const std::string& metric, std::optional<double> at, Reduction over) {
    const MetricEntry* row = find_metric(topic_, metric);
    if (row == nullptr || !row->gated()) return;
    Headline headline{metric, group_of(topic_, *row).of_sequence != nullptr, at, over};
    const std::string name = headline.name();
    const auto same = [&](const Headline& other) { return other.name() == name; };
    if (std::none_of(all_.begin(), all_.end(), same)) all_.push_back(std::move(headline));
  }

  void add_worst(const std::string& metric) {
    const auto same = [&](const Headline& other) { return other.metric == metric; };
    if (std::any_of(all_.begin(), all_.end(), same)) return;
    const MetricEntry* row = find_metric(topic_, metric);
    if (row == nullptr) return;
    const bool either = row->direction == Direction::closer_to_target;
    const bool low = row->direction == Direction::higher_is_better;
    if (either || low) add(metric, std::nullopt, Reduction::min);
    if (either || !low) add(metric, std::nullopt, Reduction::max);
  }

  std::vector<Headline> take() { return std::move(all_); }

 private:
  const Topic& topic_;
  std::vector<Headline> all_;
};

/// Of the frames that `every` looks at, the one nearest to failing.
Reduction worst_for(const ClaimSpec& claim) {
  const bool greater = claim.is == Comparison::greater_equal || claim.is == Comparison::greater;
  return greater ? Reduction::min : Reduction::max;
}

void add_claim(const ClaimSpec& claim, const std::vector<StudySpec>& studies, Headlines& all) {
  if (const StudySpec* study = study_of(claim, studies)) {
    return all.add(study->quantity, std::nullopt, study->reduce);
  }
  const bool every = claim.reduce == Reduction::every;
  all.add(claim.metric, claim.at_parameter, every ? worst_for(claim) : claim.reduce);
  if (claim.of_reduce) all.add(claim.metric, std::nullopt, *claim.of_reduce);
}

}  // namespace

std::string Headline::name() const {
  if (of_sequence) return metric;
  return at ? metric + "@" + number_text(*at) : metric + "." + text_of(over);
}

std::vector<Headline> headlines(const Experiment& experiment, const Topic& topic) {
  Headlines all(topic);
  for (const ClaimSpec& claim : experiment.claims) add_claim(claim, experiment.studies, all);
  for (const std::string& metric : experiment.view.metrics) all.add_worst(metric);
  for (const std::string& metric : experiment.checked_metrics) all.add_worst(metric);
  return all.take();
}

std::optional<double> headline_value(const CaseRecord& in, const VariantRecord& variant,
                                     const Headline& headline) {
  if (headline.of_sequence) {
    const auto value = variant.summary.find(headline.metric);
    return value == variant.summary.end() ? std::nullopt : std::optional(value->second.value);
  }
  const auto column = variant.metrics.find(headline.metric);
  if (column == variant.metrics.end()) return std::nullopt;
  if (!headline.at) return reduced(column->second.values, headline.over);
  return value_at(in, variant, headline.metric, *headline.at).value_or(kNoHeadline);
}

std::string without_statistic(const std::string& name) {
  if (name.find(':') != std::string::npos) return name;
  return name.substr(0, std::min(name.rfind('@'), name.rfind('.')));
}

}  // namespace geoprior
