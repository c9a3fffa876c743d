#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/skinning/operators.h"

namespace geoprior {
namespace {

constexpr int kIntervals = 1024;
constexpr double kPi = std::numbers::pi;

/// Smooth step of all orders from (0, 0) to (1, 1).
double kappa(double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  return 1 - std::exp(1 - 1 / (1 - std::exp(1 - 1 / x)));
}

/// theta(alpha) of the finger in the gradient-controlled operator's report: union up to pi/8.
double smooth_finger_theta(double alpha) {
  constexpr double kAlpha0 = kPi / 8, kAlpha1 = kPi / 2;
  constexpr double kTheta0 = kPi / 4, kTheta1 = kPi / 10;
  if (alpha <= kAlpha0) return kTheta0;
  if (alpha >= kAlpha1) return kTheta1;
  const double x = (alpha - kAlpha1) / (kAlpha0 - kAlpha1);
  return std::sqrt(kappa(x)) * (kTheta0 - kTheta1) + kTheta1;
}

/// Three points of F over cos(alpha) and the powers of the two pieces between them.
struct Curve {
  double x0, f0, x1, f1, x2, f2;
  double power_left = 1;
  double power_right = 1;
};

Curve curve_of(OpeningPreset preset) {
  switch (preset) {
    case OpeningPreset::elbow:
      return {0.2, 1, 0.7, 0.43, 1.2, 1};
    case OpeningPreset::elbow_soft:
      return {0, 1, 0.6, 0.55, 0.95, 1};
    case OpeningPreset::finger:
      return {-1, 1, 0.2, 0.3, 0.75, 1};
    case OpeningPreset::bulge:
      return {-1.05, 0, 0.1, 0, 0.7, 1, 2.9, 0.05};
    case OpeningPreset::flat_blend:
      return {-1, 0, 0, 0, 1, 0};
    case OpeningPreset::flat_max:
    case OpeningPreset::smooth_finger:
      break;
  }
  return {-1, 1, 0, 1, 1, 1};
}

/// Rise of a piece, x in [0, 1]: the middle 80 % of kappa, stretched to reach 0 and 1.
double rise(double x, double power) {
  const double low = kappa(0.1), high = kappa(0.9);
  const double y = (kappa(0.8 * std::clamp(x, 0.0, 1.0) + 0.1) - low) / (high - low);
  return std::pow(std::clamp(y, 0.0, 1.0), power);
}

double curve_theta(const Curve& c, double cos_alpha) {
  const double x0 = std::max(c.x0, -1.0), x2 = std::min(c.x2, 1.0);
  const double left = rise((cos_alpha - x0) / (c.x1 - x0), c.power_left);
  const double right = rise((cos_alpha - c.x1) / (x2 - c.x1), c.power_right);
  const double f = cos_alpha < c.x1 ? c.f0 + left * (c.f1 - c.f0) : c.f1 + right * (c.f2 - c.f1);
  return 0.2499 * kPi * f + 1e-5;
}

}  // namespace

Opening::Opening(OpeningPreset preset) : table_(kIntervals + 1) {
  const Curve curve = curve_of(preset);
  for (int i = 0; i <= kIntervals; ++i) {
    const double c = -1 + 2.0 * i / kIntervals;
    double tangent = std::tan(preset == OpeningPreset::smooth_finger
                                  ? smooth_finger_theta(std::acos(std::clamp(c, -1.0, 1.0)))
                                  : curve_theta(curve, c));
    if (tangent > 0.999) tangent = 1;  // F = 1 means the union, not a blend of width 1e-3
    table_[static_cast<std::size_t>(i)] = static_cast<float>(tangent);
  }
}

double Opening::tan_theta(double cos_alpha) const {
  const double x = (std::clamp(cos_alpha, -1.0, 1.0) + 1) * (kIntervals / 2.0);
  const int i = std::min(kIntervals - 1, static_cast<int>(x));
  const auto k = static_cast<std::size_t>(i);
  const double s = x - i;
  return (1 - s) * static_cast<double>(table_[k]) + s * static_cast<double>(table_[k + 1]);
}

}  // namespace geoprior
