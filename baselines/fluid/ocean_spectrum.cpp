#include <algorithm>
#include <cmath>
#include <numbers>

#include "baselines/fluid/ocean.h"

namespace geoprior {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPhillipsAlpha = 8.1e-3;
constexpr double kOnTheJump = 1e-12;

double square(double x) { return x * x; }

/// dw/dk of w^2 = g k tanh(k H).
double group_velocity(double k, double omega, const OceanOptions& o) {
  const double kh = k * o.depth;
  const double t = std::tanh(kh);
  return o.gravity / (2 * omega) * (t + kh * (1 - t * t));
}

/// Peak of a sea that the wind has raised as high as it can: 0.87 g/U of Pierson and Moskowitz, at
/// which 4 beta (w0/w)^4 = 5 puts it.
constexpr double kDevelopedOmega = 0.87;
constexpr double kDevelopedBeta = 1.291;

/// X = g F / U^2.
double dimensionless_fetch(const OceanOptions& o) {
  return o.gravity * o.fetch / square(o.wind_speed);
}

double peak_frequency(const OceanOptions& o) {
  const double scale = o.gravity / o.wind_speed;
  if (o.spectrum == SpectrumKind::jonswap || o.spectrum == SpectrumKind::tma) {
    return 2 * kPi * 3.5 * scale * std::pow(dimensionless_fetch(o), -0.33);
  }
  return kDevelopedOmega * std::pow(4 * kDevelopedBeta / 5, 0.25) * scale;
}

/// alpha g^2 / w^5 exp(-beta (w0/w)^4).
double alpha_beta(double omega, double alpha, double beta, double omega0, double g) {
  return alpha * square(g) / std::pow(omega, 5) * std::exp(-beta * square(square(omega0 / omega)));
}

double jonswap(double omega, const OceanOptions& o) {
  const double alpha = 0.076 * std::pow(dimensionless_fetch(o), -0.22);
  const double peak = peak_frequency(o);
  const double sigma = omega <= peak ? 0.07 : 0.09;
  const double bell = std::exp(-square((omega - peak) / (sigma * peak)) / 2);
  return alpha_beta(omega, alpha, 1.25, peak, o.gravity) * std::pow(o.peak_enhancement, bell);
}

/// Kitaigorodskii's factor: the spectrum keeps its shape in k, not in w, when the water gets
/// shallow: (k^-3 dk/dw) over the same in deep water.
double depth_factor(double k, double depth) {
  const double kh = k * depth;
  if (kh > 20) return 1;
  return square(std::tanh(kh)) / (1 + 2 * kh / std::sinh(2 * kh));
}

/// Integral of P over the directions, per k dk: F(k) with m0 = int F(k) k dk.
double omnidirectional(double k, double omega, const OceanOptions& o) {
  if (o.spectrum == SpectrumKind::phillips) {
    const double longest = square(o.wind_speed) / o.gravity;
    return kPhillipsAlpha / 2 * std::exp(-1 / square(k * longest)) / square(square(k));
  }
  double s = 0;
  if (o.spectrum == SpectrumKind::pierson_moskowitz) {
    s = alpha_beta(omega, kPhillipsAlpha, kDevelopedBeta,
                   kDevelopedOmega * o.gravity / o.wind_speed, o.gravity);
  } else {
    s = jonswap(omega, o);
    if (o.spectrum == SpectrumKind::tma) s *= depth_factor(k, o.depth);
  }
  return s * group_velocity(k, omega, o) / k;
}

/// D(theta) = G(s) cos^2s(theta/2), G = Gamma(s + 1) / (2 sqrt(pi) Gamma(s + 1/2)).
double mitsuyasu(double cosine, double omega, const OceanOptions& o) {
  const double peak = peak_frequency(o);
  const double s = 11.5 * std::pow(o.wind_speed * peak / o.gravity, -2.5) *
                   std::pow(omega / peak, omega <= peak ? 5 : -2.5);
  // Stirling's series where the Gamma function would overflow; relative error 4e-8 at s = 50.
  const double ratio =
      s > 50 ? std::sqrt(s + 0.25 + 1 / (32 * s)) : std::tgamma(s + 1) / std::tgamma(s + 0.5);
  return ratio / (2 * std::sqrt(kPi)) * std::pow(std::max(0.0, (1 + cosine) / 2), s);
}

/// D(theta), integral 1 over the circle.
double spreading(double cosine, double omega, const OceanOptions& o) {
  switch (o.spreading) {
    case SpreadingKind::none:
      return 1 / (2 * kPi);
    case SpreadingKind::cosine_squared:
      return cosine > 0 ? 2 / kPi * square(cosine) : 0;
    case SpreadingKind::mitsuyasu:
      return mitsuyasu(cosine, omega, o);
    case SpreadingKind::one_sided:
      // Half of the value on the jump, so that sums over a grid of modes do not lose its column.
      if (std::abs(cosine) < kOnTheJump) return 1 / (2 * kPi);
      return cosine > 0 ? 1 / kPi : 0;
  }
  return 0;
}

}  // namespace

double ocean_frequency(const OceanOptions& options, double k) {
  return std::sqrt(options.gravity * k * std::tanh(k * options.depth));
}

double ocean_spectrum(const OceanOptions& options, const Eigen::Vector2d& k) {
  const double length = k.norm();
  if (!(length > 0)) return 0;
  const double omega = ocean_frequency(options, length);
  const double angle = options.wind_direction_deg * kPi / 180;
  const double cosine =
      std::clamp(k.dot(Eigen::Vector2d(std::cos(angle), std::sin(angle))) / length, -1.0, 1.0);
  const double damping = std::exp(-square(length * options.smallest_wave / (2 * kPi)));
  return omnidirectional(length, omega, options) * spreading(cosine, omega, options) * damping;
}

}  // namespace geoprior
