#pragma once

#include <algorithm>

namespace geoprior::embryo {

/// How values go from key to key: by monotone cubics of continuous velocity, or straight.
enum class Interpolation { monotone, linear };

/// Share of a process that is done, from 0 to 1 between two days: 3 u^2 - 2 u^3, which begins and
/// ends at rest, or u where motion is linear. 1 from `to` on where the two are one day.
inline double eased(double day, double from, double to, Interpolation interpolation) {
  if (day >= to) return 1;
  if (day <= from) return 0;
  const double u = (day - from) / (to - from);
  return interpolation == Interpolation::linear ? u : u * u * (3 - 2 * u);
}

/// The lesser of a value and a bound, with a continuous derivative: min(a, b) - h^2 / (4 k),
/// h = max(k - |a - b|, 0). Never above either; the value itself k or more below the bound, the
/// bound itself for a value k or more above it. Sharp for k = 0.
inline double bounded(double value, double bound, double k) {
  const double least = std::min(value, bound), gap = std::max(value, bound) - least;
  if (!(gap < k)) return least;
  return least - (k - gap) * (k - gap) / (4 * k);
}

}  // namespace geoprior::embryo
