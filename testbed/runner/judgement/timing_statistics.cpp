#include "testbed/runner/judgement/timing_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "core/random.h"

namespace geoprior {

namespace {

/// Reorders `values`, which holds no NaN.
double quantile_in_place(std::vector<double>& values, double p) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double position = std::clamp(p, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto lower = static_cast<std::size_t>(position);
  const auto at = values.begin() + lower;
  std::nth_element(values.begin(), at, values.end());
  const double low = *at;
  const double weight = position - static_cast<double>(lower);
  if (weight == 0) return low;
  return low + weight * (*std::min_element(at + 1, values.end()) - low);
}

std::vector<double> without_nan(std::span<const double> values) {
  std::vector<double> kept;
  std::copy_if(values.begin(), values.end(), std::back_inserter(kept),
               [](double x) { return !std::isnan(x); });
  return kept;
}

}  // namespace

double quantile(std::span<const double> values, double p) {
  std::vector<double> kept = without_nan(values);
  return quantile_in_place(kept, p);
}

double median(std::span<const double> values) { return quantile(values, 0.5); }

double interquartile_range(std::span<const double> values) {
  return quantile(values, 0.75) - quantile(values, 0.25);
}

Interval bootstrap_median(std::span<const double> values, std::uint64_t seed) {
  const std::vector<double> kept = without_nan(values);
  Interval result;
  result.value = median(kept);
  if (kept.empty()) return {result.value, result.value, result.value};
  RandomStream random(seed, "bootstrap");
  std::vector<double> medians(kResamples);
  std::vector<double> sample(kept.size());
  for (double& of_sample : medians) {
    for (double& x : sample) x = kept[random.below(static_cast<std::uint32_t>(kept.size()))];
    of_sample = quantile_in_place(sample, 0.5);
  }
  result.low = quantile(medians, 0.025);
  result.high = quantile(medians, 0.975);
  return result;
}

Interval median_of_paired_ratios(std::span<const double> a, std::span<const double> b,
                                 std::uint64_t seed) {
  if (a.size() != b.size()) throw Error("paired samples of unequal length");
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isnan(a[i]) && b[i] > 0) ratios.push_back(a[i] / b[i]);
  }
  if (ratios.empty()) throw Error("no pair of times to compare");
  if (ratios.size() == 1) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return {ratios.front(), none, none};
  }
  return bootstrap_median(ratios, seed);
}

}  // namespace geoprior
