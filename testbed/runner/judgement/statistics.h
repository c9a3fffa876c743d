#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "core/random.h"
#include "testbed/runner/judgement/interval.h"

namespace geoprior {

double mean(std::span<const double> values);

double largest_over_smallest(std::span<const double> values);

/// Value with the 95 % percentile interval of its resamples, which it sorts.
Interval percentile_interval(double value, std::vector<double>& resampled);

/// Slope of the least-squares line through (x, y) with its 95 % t-interval, normal errors in y.
/// Two points fix the slope and say nothing of its error: the interval is NaN.
/// @throws Error  with fewer than two different x
Interval slope_with_interval(std::span<const double> x, std::span<const double> y);

/// Sample standard deviation (n - 1) with its 95 % percentile bootstrap interval (2000 resamples).
/// @throws Error  with fewer than two values
Interval spread_with_interval(std::span<const double> values, RandomStream random);

/// Largest over smallest of the samples, each reduced to one number, with its 95 % percentile
/// bootstrap interval (2000 resamples of each sample by itself).
Interval range_with_interval(const std::vector<std::vector<double>>& samples,
                             const std::function<double(std::vector<double>)>& reduce,
                             RandomStream random);

/// How far apart the medians of two samples are, |median(values) - median(yardstick)|, over half
/// the range of `yardstick`: at most 1 means that they agree within its spread. The 95 % percentile
/// bootstrap interval (2000 resamples) draws both samples anew and keeps the range: that of a
/// resample is never larger, and would bias the ratio upward. A yardstick without a spread gives 0
/// for equal medians and infinity for others.
/// @throws Error  with fewer than two values of either
Interval median_distance_with_interval(std::span<const double> values,
                                       std::span<const double> yardstick, RandomStream random);

/// Student's 95 % interval about `value` of the standard error that the jackknife gives (Efron
/// 1982): of n parts of a sample `without` has the value of all but one each, and the squared error
/// is (n - 1) / n times the sum of their squared distances from their mean.
/// @throws Error  with fewer than two values
Interval jackknife_interval(double value, std::span<const double> without);

/// t with P(|T| <= t) = probability for Student's distribution (Abramowitz and Stegun 26.7.3-4).
double student_t(double probability, int degrees_of_freedom);

}  // namespace geoprior
