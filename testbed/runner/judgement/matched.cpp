#include "testbed/runner/judgement/matched.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/error.h"
#include "testbed/runner/judgement/statistics.h"
#include "testbed/runner/judgement/timing_statistics.h"

namespace geoprior {
namespace {

std::vector<double> at_cases(const std::vector<double>& values, const std::vector<int>& cases) {
  std::vector<double> chosen;
  chosen.reserve(cases.size());
  for (const int i : cases) chosen.push_back(values[static_cast<std::size_t>(i)]);
  return chosen;
}

Priced at_cases(const Priced& variant, const std::vector<int>& cases) {
  Priced chosen{at_cases(variant.cost, cases), at_cases(variant.quality, cases)};
  if (!variant.kept.empty()) chosen.kept = at_cases(variant.kept, cases);
  return chosen;
}

Matched at_cases(const Matched& all, const std::vector<int>& cases) {
  Matched chosen{at_cases(all.method, cases), {}, {}, all.cost, all.within};
  for (const auto& family : all.families) {
    auto& members = chosen.families.emplace_back();
    for (const Priced& member : family) members.push_back(at_cases(member, cases));
  }
  if (!all.truth.empty()) chosen.truth = at_cases(all.truth, cases);
  return chosen;
}

double kept_of(const Priced& variant) { return variant.kept.empty() ? 0 : mean(variant.kept); }

/// What a family costs at an error.
double cost_at(double error, const std::vector<Priced>& family, const Matched& all) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double least_kept = kept_of(all.method) - all.within;
  double best = kNever, at_best = 0, kept_at_best = 0;
  for (const Priced& member : family) {
    const double e = error_of(member, all.truth), cost = cost_of(member, all.cost);
    const double kept = kept_of(member);
    if (!(e < best)) continue;
    if (e <= error) {
      const bool between = std::isfinite(best) && e > 0;
      const double t = between ? std::log(best / error) / std::log(best / e) : 1;
      if (!((1 - t) * kept_at_best + t * kept >= least_kept)) return kNever;
      return between ? at_best * std::pow(cost / at_best, t) : cost;
    }
    best = e;
    at_best = cost;
    kept_at_best = kept;
  }
  return kNever;
}

}  // namespace

double error_of(const Priced& variant, const std::vector<double>& truth) {
  if (truth.empty()) return mean(variant.quality);
  std::vector<double> a = variant.quality, b = truth;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

double cost_of(const Priced& variant, Reduction over) {
  return over == Reduction::mean ? mean(variant.cost) : median(variant.cost);
}

double matched_ratio(const Matched& all) {
  const double error = error_of(all.method, all.truth);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& family : all.families) least = std::min(least, cost_at(error, family, all));
  return least / cost_of(all.method, all.cost);
}

Interval matched_with_interval(const Matched& all, RandomStream random) {
  const double value = matched_ratio(all);
  const std::size_t n = all.method.cost.size();
  for (const auto& family : all.families) {
    for (const Priced& member : family)
      if (member.cost.size() != n)
        throw Error("variants have other frames than each other", "study");
  }
  if (n < 2) return {value, std::nan(""), std::nan("")};
  std::vector<double> ratios;
  std::vector<int> cases(n);
  for (int r = 0; r < kResamples; ++r) {
    for (int& i : cases) i = static_cast<int>(random.below(static_cast<std::uint32_t>(n)));
    ratios.push_back(matched_ratio(at_cases(all, cases)));
  }
  return percentile_interval(value, ratios);
}

}  // namespace geoprior
