#pragma once

#include <algorithm>
#include <cmath>

namespace geoprior::embryo {

/// min(a, b) with a continuous derivative: min - (k - |a - b|)^2 / (4 k) where they differ by less
/// than k. Never above either. Sharp for k = 0.
inline double smooth_minimum(double a, double b, double k) {
  const double h = k - std::abs(a - b);
  return h > 0 ? std::min(a, b) - h * h / (4 * k) : std::min(a, b);
}

inline double smooth_maximum(double a, double b, double k) { return -smooth_minimum(-a, -b, k); }

}  // namespace geoprior::embryo
