#include "testbed/runner/judgement/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "testbed/runner/judgement/timing_statistics.h"

namespace geoprior {
namespace {

double standard_deviation(std::span<const double> values) {
  const double m = mean(values);
  double squares = 0;
  for (const double x : values) squares += (x - m) * (x - m);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

/// P(|T| <= t): finite series for integer degrees of freedom, theta = atan(t / sqrt(nu)).
double central_probability(double t, int nu) {
  const double theta = std::atan(t / std::sqrt(static_cast<double>(nu)));
  const double cosine = std::cos(theta), sine = std::sin(theta);
  double term = nu % 2 == 0 ? 1 : cosine, sum = nu == 1 ? 0 : term;
  for (int k = nu % 2 == 0 ? 2 : 3; k <= nu - 2; k += 2) {
    term *= cosine * cosine * (k - 1) / k;
    sum += term;
  }
  return nu % 2 == 0 ? sine * sum : 2 / std::numbers::pi * (theta + sine * sum);
}

/// Draws as many numbers from `values` as there are, with replacement, into `sample`.
void draw(std::span<const double> values, RandomStream& random, std::vector<double>& sample) {
  sample.resize(values.size());
  for (double& x : sample) x = values[random.below(static_cast<std::uint32_t>(values.size()))];
}

double ratio_to_spread(double distance, double half_range) {
  if (half_range > 0) return distance / half_range;
  return distance > 0 ? std::numeric_limits<double>::infinity() : 0;
}

}  // namespace

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double largest_over_smallest(std::span<const double> values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most / *least;
}

Interval percentile_interval(double value, std::vector<double>& resampled) {
  std::sort(resampled.begin(), resampled.end());
  const std::size_t n = resampled.size();
  return {value, resampled[n / 40], resampled[n - 1 - n / 40]};
}

Interval jackknife_interval(double value, std::span<const double> without) {
  if (without.size() < 2) throw Error("a jackknife needs two parts", "study");
  const auto n = static_cast<double>(without.size());
  const double error = standard_deviation(without) * (n - 1) / std::sqrt(n);
  const double half = student_t(0.95, static_cast<int>(without.size()) - 1) * error;
  return {value, value - half, value + half};
}

double student_t(double probability, int degrees_of_freedom) {
  double low = 0, high = 1;
  while (central_probability(high, degrees_of_freedom) < probability) high *= 2;
  for (int i = 0; i < 200 && high - low > 1e-14 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (central_probability(middle, degrees_of_freedom) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Interval slope_with_interval(std::span<const double> x, std::span<const double> y) {
  const std::size_t n = x.size();
  double sxx = 0, sxy = 0, residual = 0;
  const double mx = n == 0 ? 0 : mean(x), my = n == 0 ? 0 : mean(y);
  for (std::size_t i = 0; i < n; ++i) {
    sxx += (x[i] - mx) * (x[i] - mx);
    sxy += (x[i] - mx) * (y[i] - my);
  }
  if (n < 2 || !(sxx > 0)) throw Error("a slope needs two different x", "study");
  const double slope = sxy / sxx;
  for (std::size_t i = 0; i < n; ++i) {
    const double r = y[i] - my - slope * (x[i] - mx);
    residual += r * r;
  }
  double half = std::numeric_limits<double>::quiet_NaN();
  if (n > 2) {
    const auto freedom = static_cast<int>(n) - 2;
    half = student_t(0.95, freedom) * std::sqrt(residual / freedom / sxx);
  }
  return {slope, slope - half, slope + half};
}

Interval spread_with_interval(std::span<const double> values, RandomStream random) {
  if (values.size() < 2) throw Error("a spread needs two values", "study");
  std::vector<double> spreads, sample;
  for (int r = 0; r < kResamples; ++r) {
    draw(values, random, sample);
    spreads.push_back(standard_deviation(sample));
  }
  return percentile_interval(standard_deviation(values), spreads);
}

Interval range_with_interval(const std::vector<std::vector<double>>& samples,
                             const std::function<double(std::vector<double>)>& reduce,
                             RandomStream random) {
  const auto of = [&](const std::vector<std::vector<double>>& all) {
    std::vector<double> numbers;
    for (const std::vector<double>& sample : all) numbers.push_back(reduce(sample));
    return largest_over_smallest(numbers);
  };
  std::vector<std::vector<double>> drawn(samples.size());
  std::vector<double> ranges;
  for (int r = 0; r < kResamples; ++r) {
    for (std::size_t i = 0; i < samples.size(); ++i) draw(samples[i], random, drawn[i]);
    ranges.push_back(of(drawn));
  }
  return percentile_interval(of(samples), ranges);
}

Interval median_distance_with_interval(std::span<const double> values,
                                       std::span<const double> yardstick, RandomStream random) {
  if (values.size() < 2 || yardstick.size() < 2) throw Error("a spread needs two values", "study");
  const auto [low, high] = std::minmax_element(yardstick.begin(), yardstick.end());
  const double half_range = 0.5 * (*high - *low);
  const auto of = [&](std::span<const double> a, std::span<const double> b) {
    return ratio_to_spread(std::abs(median(a) - median(b)), half_range);
  };
  std::vector<double> ratios, sample, of_yardstick;
  for (int r = 0; r < kResamples; ++r) {
    draw(values, random, sample);
    draw(yardstick, random, of_yardstick);
    ratios.push_back(of(sample, of_yardstick));
  }
  return percentile_interval(of(values, yardstick), ratios);
}

}  // namespace geoprior
