#pragma once

#include <cmath>

#include "solvers/skinning/implicit_options.h"

namespace geoprior::skinning {

/// Field value and its derivative with respect to s = d / r.
struct SupportValue {
  double value = 0;
  double derivative = 0;
};

/// Turns a signed distance s = d / r (negative inside) into a field in [0, 1]: 1 for s <= -1, 0 for
/// s >= 1, and 1/2 (the surface) at s = 0.
///
/// quintic (C2):  f = -3/16 s^5 + 5/8 s^3 - 15/16 s + 1/2,  f' = -15/16 (1 - s^2)^2
/// cubic (C1):    f = 1/4 s^3 - 3/4 s + 1/2
/// logistic:      f = 1 / (1 + exp(7 s)), which is only nearly compact: cut at |s| = 1 to the value
///                there (9e-4)
/// Source: Vaillant et al. 2013 (quintic); the two others are alternatives of the authors' code.
inline SupportValue compact_support(SupportKind kind, double s) {
  if (s <= -1) return {1, 0};
  if (s >= 1) return {0, 0};
  const double s2 = s * s;
  switch (kind) {
    case SupportKind::cubic:
      return {s * (0.25 * s2 - 0.75) + 0.5, 0.75 * (s2 - 1)};
    case SupportKind::logistic: {
      const double f = 1 / (1 + std::exp(7 * s));
      return {f, -7 * f * (1 - f)};
    }
    case SupportKind::quintic:
      break;
  }
  const double one_minus = 1 - s2;
  return {s * (s2 * (-0.1875 * s2 + 0.625) - 0.9375) + 0.5, -0.9375 * one_minus * one_minus};
}

}  // namespace geoprior::skinning
