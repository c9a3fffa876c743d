#pragma once

#include <cstdint>
#include <span>

#include "testbed/runner/judgement/interval.h"

namespace geoprior {

/// The p-quantile (0 … 1) by linear interpolation of the order statistics (Hyndman and Fan 1996,
/// type 7, as numpy). NaN for no values; NaN among the values are left out.
double quantile(std::span<const double> values, double p);

/// The 0.5-quantile.
double median(std::span<const double> values);

/// The 0.75-quantile less the 0.25-quantile.
double interquartile_range(std::span<const double> values);

/// Median of the values with the percentile bootstrap's 95 % interval (Efron 1979; 2000 resamples
/// drawn with a PCG stream of `seed`: same values, same interval).
Interval bootstrap_median(std::span<const double> values, std::uint64_t seed);

/// Median of a[i] / b[i] with its bootstrap 95 % interval. Pairs with a NaN or b <= 0 are left out;
/// one pair says nothing of the spread: the interval is NaN.
/// @throws Error  when the lengths differ or no pair is left
Interval median_of_paired_ratios(std::span<const double> a, std::span<const double> b,
                                 std::uint64_t seed);

}  // namespace geoprior
