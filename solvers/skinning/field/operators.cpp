#include "solvers/skinning/field/operators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace geoprior::skinning {
namespace {

using std::numbers::pi;

constexpr double kBlendTip = 0.7;
constexpr double kBulgeTip = 0.55;

BlendValue swapped(const BlendValue& b) { return {b.value, b.d2, b.d1}; }

/// One linear piece of the boundary, k(C) = -a - b C.
struct BoundaryPiece {
  double a;
  double b;
};

/// Root of (f1 + a + b C)^2 + (f2 + a + b C)^2 = (C + a + b C)^2.
BlendValue arc_value(double f1, double f2, BoundaryPiece piece) {
  const auto [a, b] = piece;
  const double u = b * b - 2 * b - 1;
  const double v = 2 * b * (f1 + f2 + a) - 2 * a;
  const double w = (f1 + a) * (f1 + a) + (f2 + a) * (f2 + a) - a * a;
  const double discriminant = std::max(0.0, v * v - 4 * u * w);
  const double c = std::abs(u) < 1e-4 ? -w / v : (-v - std::sqrt(discriminant)) / (2 * u);
  const double x = f1 + a + b * c;
  const double y = f2 + a + b * c;
  const double h_c = 2 * b * (x + y) - 2 * (1 + b) * (c + a + b * c);
  if (std::abs(h_c) < 1e-12) return union_max(f1, f2);
  return {c, -2 * x / h_c, -2 * y / h_c};
}

/// Uniform cubic B-spline over control values 0 0 0 1 2 3 4 5 4 4 4, u in [0, 1]; value and slope.
std::array<double, 2> bulge_shape(double u) {
  constexpr std::array<double, 11> control{0, 0, 0, 1, 2, 3, 4, 5, 4, 4, 4};
  constexpr int kSpans = 8;
  const double x = std::clamp(u, 0.0, 1.0) * kSpans;
  const int span = std::min(kSpans - 1, static_cast<int>(x));
  const double s = x - span;
  const auto at = [&](int k) { return control[span + k]; };
  const double r = 1 - s;
  const double value = (r * r * r * at(0) + (3 * s * s * s - 6 * s * s + 4) * at(1) +
                        (-3 * s * s * s + 3 * s * s + 3 * s + 1) * at(2) + s * s * s * at(3)) /
                       6;
  const double slope = (-r * r * at(0) + (3 * s * s - 4 * s) * at(1) +
                        (-3 * s * s + 2 * s + 1) * at(2) + s * s * at(3)) /
                       2;
  return {value, slope * kSpans};
}

/// Slope dk/df of the boundary at f.
double boundary_slope(double f, double t, double tip) {
  return f <= 0.5 ? t : (tip - 0.5 * t) / (tip - 0.5);
}

/// The f at which the boundary has the value k.
double boundary_inverse(double k, double t, double tip) {
  return k <= 0.5 * t ? k / std::max(t, 1e-12)
                      : 0.5 + (k - 0.5 * t) * (tip - 0.5) / (tip - 0.5 * t);
}

/// |(f1 - k, f2 - k)| - P (C - k) and its derivatives, f1 >= f2 >= k.
struct ProfileEquation {
  double h;
  double h1;
  double h2;
  double h_c;
};

ProfileEquation profile_equation(double f1, double f2, double c, double t, double tip, double p) {
  const double k = blend_boundary(c, t, tip);
  const double slope = boundary_slope(c, t, tip);
  const double x = std::max(f1 - k, 1e-15);
  const double y = std::max(f2 - k, 0.0);
  const double length = std::hypot(x, y);
  const auto [shape, shape_slope] = bulge_shape(y / x);
  const double profile = 1 - p * shape;
  const double p_x = p * shape_slope * y / (x * x);  // dP/dx = -p shape' d(y/x)/dx
  const double p_y = -p * shape_slope / x;
  const double h1 = x / length - p_x * (c - k);
  const double h2 = y / length - p_y * (c - k);
  return {length - profile * (c - k), h1, h2, -slope * (h1 + h2) - profile * (1 - slope)};
}

/// The case f1 >= f2 of the general construction.
BlendValue ordered_profile_blend(double f1, double f2, double t, double tip, double p) {
  if (t >= 1 || f1 >= tip || f2 <= blend_boundary(f1, t, tip)) return {f1, 1, 0};
  double low = f1;
  double high = boundary_inverse(f2, t, tip);
  for (int i = 0; i < 60 && high - low > 1e-15; ++i) {
    const double middle = 0.5 * (low + high);
    (profile_equation(f1, f2, middle, t, tip, p).h >= 0 ? low : high) = middle;
  }
  const double c = 0.5 * (low + high);
  const ProfileEquation e = profile_equation(f1, f2, c, t, tip, p);
  if (std::abs(e.h_c) < 1e-12) return {f1, 1, 0};
  return {c, -e.h1 / e.h_c, -e.h2 / e.h_c};
}

/// Field of solid 1 in contact with 2, and its derivative with respect to f2.
std::array<double, 2> receding_field(double f1, double f2, double w) {
  const double x = 0.5 - f2;
  if (x <= 0) return {f1 + x, -1};
  if (x >= w) return {f1, 0};
  const double rest = 1 - x / w;
  return {f1 + x * rest * rest, -(rest * rest - 2 * x / w * rest)};
}

}  // namespace

BlendValue union_max(double f1, double f2) {
  return f1 >= f2 ? BlendValue{f1, 1, 0} : BlendValue{f2, 0, 1};
}

BlendValue ricci(double f1, double f2, double n) {
  const double high = std::max(f1, f2);
  if (high <= 0) return {0, 1, 0};
  const double x = std::pow(f1 / high, n);
  const double y = std::pow(f2 / high, n);
  const double g = high * std::pow(x + y, 1 / n);
  return {g, std::pow(f1 / g, n - 1), std::pow(f2 / g, n - 1)};
}

double blend_boundary(double f, double t, double tip) {
  if (f <= 0.5) return t * f;
  if (f >= tip) return f;
  return 0.5 * t + (f - 0.5) * (tip - 0.5 * t) / (tip - 0.5);
}

BlendValue gradient_controlled(double f1, double f2, double t) {
  if (f2 > f1) return swapped(gradient_controlled(f2, f1, t));
  if (t >= 1 || f1 >= kBlendTip || f2 <= blend_boundary(f1, t, kBlendTip)) return {f1, 1, 0};
  // Upper piece where the arc of value 1/2 lies below (f1, f2).
  const double x = f1 - 0.5 * t;
  const double y = f2 - 0.5 * t;
  const double radius = 0.5 - 0.5 * t;
  const bool upper = f1 > 0.5 || (x > 0 && x * x + y * y > radius * radius && y > 0);
  return upper ? arc_value(f1, f2, {-1.75 * (t - 1), -0.5 * (7 - 5 * t)})
               : arc_value(f1, f2, {0, -t});
}

BlendValue profile_blend(double f1, double f2, double t, double tip, double p) {
  return f1 >= f2 ? ordered_profile_blend(f1, f2, t, tip, p)
                  : swapped(ordered_profile_blend(f2, f1, t, tip, p));
}

BlendValue bulge_in_contact(double f1, double f2, double t, double p) {
  return profile_blend(f1, f2, t, kBulgeTip, p);
}

BlendValue contact(double f1, double f2, double w) {
  const auto [v1, d12] = receding_field(f1, f2, w);
  const auto [v2, d21] = receding_field(f2, f1, w);
  return v1 >= v2 ? BlendValue{v1, 1, d12} : BlendValue{v2, d21, 1};
}

JointOperator::JointOperator(BlendKind kind, OpeningPreset preset, double ricci_exponent)
    : kind_(kind), ricci_exponent_(ricci_exponent), opening_(preset) {}

BlendValue JointOperator::operator()(double f1, double f2, double cos_alpha) const {
  switch (kind_) {
    case BlendKind::union_max:
      break;
    case BlendKind::ricci:
      return ricci(f1, f2, ricci_exponent_);
    case BlendKind::gradient_controlled:
      return gradient_controlled(f1, f2, opening_.tan_theta(cos_alpha));
    case BlendKind::bulge_in_contact:
      return bulge_in_contact(f1, f2, opening_.tan_theta(cos_alpha));
    case BlendKind::contact: {
      // Where the gradients agree there is no contact: fade to the union with the opening.
      const BlendValue joined = union_max(f1, f2);
      const double t = opening_.tan_theta(cos_alpha);
      if (t >= 1) return joined;
      const BlendValue apart = contact(f1, f2);
      return {joined.value + (1 - t) * (apart.value - joined.value),
              joined.d1 + (1 - t) * (apart.d1 - joined.d1),
              joined.d2 + (1 - t) * (apart.d2 - joined.d2)};
    }
  }
  return union_max(f1, f2);
}

namespace {

constexpr int kIntervals = 1024;

/// Smooth step of all orders from (0, 0) to (1, 1).
double kappa(double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  return 1 - std::exp(1 - 1 / (1 - std::exp(1 - 1 / x)));
}

/// theta(alpha) of the finger in the gradient-controlled operator's report: union up to pi/8.
double smooth_finger_theta(double alpha) {
  constexpr double kAlpha0 = pi / 8, kAlpha1 = pi / 2;
  constexpr double kTheta0 = pi / 4, kTheta1 = pi / 10;
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
  return 0.2499 * pi * f + 1e-5;
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
    table_[i] = static_cast<float>(tangent);
  }
}

double Opening::tan_theta(double cos_alpha) const {
  const double x = (std::clamp(cos_alpha, -1.0, 1.0) + 1) * (kIntervals / 2.0);
  const int i = std::min(kIntervals - 1, static_cast<int>(x));
  const double s = x - i;
  return (1 - s) * static_cast<double>(table_[i]) + s * static_cast<double>(table_[i + 1]);
}

}  // namespace geoprior::skinning
