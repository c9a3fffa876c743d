#include <algorithm>
#include <cmath>

#include "baselines/fluid/surface_kernels.h"

namespace geoprior {
namespace {

constexpr int kSteps = 1024;  ///< of the table

/// Integral of (1 - z^2)^4 from -1 to x: the kernel's mass on one side of a plane, up to a factor.
double mass_below(double x) {
  const double x2 = x * x;
  const double odd = x * (1 + x2 * (-4.0 / 3 + x2 * (6.0 / 5 + x2 * (-4.0 / 7 + x2 / 9))));
  return odd + 128.0 / 315;
}

/// What is measured at the distance -x from the surface (inside for x > 0).
double measured_at(FlatSurfaceProfile::Measure measure, double x) {
  const double mass = mass_below(x);
  if (measure == FlatSurfaceProfile::Measure::density) return mass / mass_below(1);
  // The first moment of (1 - z^2)^4 is -(1 - x^2)^5 / 10.
  return mass > 1e-15 ? std::pow(1 - x * x, 5) / (10 * mass) : 1;
}

}  // namespace

FlatSurfaceProfile::FlatSurfaceProfile(Measure measure) : distance_(kSteps + 1) {
  const double rises = measure == Measure::density ? 1 : -1;
  for (int s = 0; s <= kSteps; ++s) {
    const double wanted = static_cast<double>(s) / kSteps;
    double low = -1, high = 1;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (low + high);
      (rises * (measured_at(measure, middle) - wanted) < 0 ? low : high) = middle;
    }
    distance_[static_cast<std::size_t>(s)] =
        std::max(static_cast<float>(-0.5 * (low + high)), -kDeepest);
  }
}

float FlatSurfaceProfile::distance(float measured) const {
  const float at = std::clamp(measured, 0.0F, 1.0F) * kSteps;
  const int step = std::min(static_cast<int>(at), kSteps - 1);
  const float t = at - static_cast<float>(step);
  const auto i = static_cast<std::size_t>(step);
  return distance_[i] + t * (distance_[i + 1] - distance_[i]);
}

}  // namespace geoprior
