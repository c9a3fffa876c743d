#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "baselines/fluid/ocean/ocean.h"
#include "tests/fluid/ocean/modes.h"

namespace geoprior::fluid {
namespace {

using std::numbers::pi;

constexpr double kG = 9.81;

constexpr std::array kSpectra{SpectrumKind::phillips, SpectrumKind::pierson_moskowitz,
                              SpectrumKind::jonswap, SpectrumKind::tma};

OceanOptions with(SpectrumKind spectrum, SpreadingKind spreading = SpreadingKind::none) {
  OceanOptions o;
  o.spectrum = spectrum;
  o.spreading = spreading;
  o.depth = 1e5;
  return o;
}

/// Integral over the directions of P at a wave number (m^4).
double around(const OceanOptions& o, double k) {
  constexpr int kDirections = 3600;
  double sum = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double theta = 2 * pi * (i + 0.5) / kDirections;
    sum += ocean_spectrum(o, k * Eigen::Vector2d(std::cos(theta), std::sin(theta)));
  }
  return sum * 2 * pi / kDirections;
}

/// Variance of waves of wave numbers up to `highest`: integral of k P over directions and k.
double variance_up_to(const OceanOptions& o, double highest) {
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double k = highest * (i + 0.5) / kSteps;
    sum += 2 * pi * ocean_spectrum(o, Eigen::Vector2d(k, 0)) * k * highest / kSteps;
  }
  return sum;
}

TEST(OceanSpectrum, SpreadingIsNormalised) {
  for (const auto spectrum : kSpectra) {
    for (const double k : {0.05, 0.1, 0.3, 2.0}) {
      const double whole = around(with(spectrum), k);
      for (const auto spreading :
           {SpreadingKind::cosine_squared, SpreadingKind::mitsuyasu, SpreadingKind::one_sided}) {
        OceanOptions o = with(spectrum, spreading);
        o.wind_direction_deg = 37;
        EXPECT_NEAR(around(o, k) / whole, 1, 1e-3) << static_cast<int>(spreading);
      }
    }
  }
}

// A narrow wind on a long fetch has s in the thousands at the peak, where the Gamma function
// overflows.
TEST(OceanSpectrum, NarrowSpreadingIsNormalised) {
  OceanOptions o = with(SpectrumKind::jonswap, SpreadingKind::mitsuyasu);
  o.wind_speed = 3;
  o.fetch = 1e6;
  const double peak = 22 * kG / 3 * std::pow(kG * 1e6 / 9, -0.33);
  const double k = peak * peak / kG;
  OceanOptions all = o;
  all.spreading = SpreadingKind::none;
  EXPECT_NEAR(around(o, k) / around(all, k), 1, 1e-6);
}

// m0 = alpha g^2 / (4 beta w0^4), the integral of S; alpha, beta, w0 as in the definition. Below a
// frequency: times exp(-beta (w0/w)^4).
TEST(OceanSpectrum, PiersonMoskowitzHasItsClosedFormVariance) {
  const OceanOptions o = with(SpectrumKind::pierson_moskowitz);
  const double omega0 = 0.87 * kG / 10, highest = 4;
  const double ratio = omega0 / std::sqrt(kG * highest);
  const double m0 = 8.1e-3 * kG * kG / (4 * 1.291 * std::pow(omega0, 4));
  EXPECT_NEAR(variance_up_to(o, highest) / (m0 * std::exp(-1.291 * std::pow(ratio, 4))), 1, 1e-5);
  // The developed sea has a significant height of 0.21 U^2/g (Stewart 2008, 16.4).
  EXPECT_NEAR(4 * std::sqrt(m0) * kG / 100, 0.21, 0.005);
}

// gamma = 1: m0 = alpha g^2 / (5 wp^4). gamma = 3.3 raises it by 1 / (1 - 0.287 ln gamma), a fit
// (DNV-RP-C205, 3.5.5.3) good to about 1 %.
TEST(OceanSpectrum, JonswapHasItsVariance) {
  OceanOptions o = with(SpectrumKind::jonswap);
  o.peak_enhancement = 1;
  const double fetch = kG * o.fetch / 100;
  const double alpha = 0.076 * std::pow(fetch, -0.22);
  const double peak = 22 * std::pow(fetch, -0.33) * kG / 10 * (2 * pi * 3.5 / 22);
  const double highest = 8, below = std::exp(-1.25 * std::pow(peak * peak / kG / highest, 2));
  const double m0 = alpha * kG * kG / (5 * std::pow(peak, 4));
  const double plain = variance_up_to(o, highest);
  EXPECT_NEAR(plain / (m0 * below), 1, 1e-4);
  o.peak_enhancement = 3.3;
  EXPECT_NEAR(variance_up_to(o, highest) / plain, 1 / (1 - 0.287 * std::log(3.3)), 0.015);
}

// Integral of alpha/2 exp(-1/(k l)^2) k^-3 dk = alpha l^2 / 4 exp(-1/(k l)^2), l = U^2/g.
TEST(OceanSpectrum, PhillipsHasItsClosedFormVariance) {
  const double l = 100 / kG, highest = 10;
  EXPECT_NEAR(variance_up_to(with(SpectrumKind::phillips), highest) /
                  (8.1e-3 * l * l / 4 * std::exp(-1 / std::pow(highest * l, 2))),
              1, 1e-5);
}

// The modes of a patch are a midpoint rule for that integral over the square |kx|, |ky| < N pi/L,
// which lies between two discs.
TEST(OceanSpectrum, ModesOfAPatchSumToTheIntegral) {
  for (const auto spectrum : kSpectra) {
    for (const auto spreading : {SpreadingKind::cosine_squared, SpreadingKind::one_sided}) {
      OceanOptions o = with(spectrum, spreading);
      o.size = 3000;
      o.samples = 512;
      const double nyquist = pi * o.samples / o.size;
      const double sum = Ocean(o, 1).expected_variance();
      OceanOptions all = with(spectrum);
      EXPECT_GT(sum, 0.995 * variance_up_to(all, nyquist)) << static_cast<int>(spectrum);
      EXPECT_LT(sum, 1.005 * variance_up_to(all, nyquist * std::numbers::sqrt2));
    }
  }
}

// k^-4 in two dimensions; S ~ w^-5 in deep water is the same: P = S (dw/dk) / k, w^2 = g k.
TEST(OceanSpectrum, TailsFallAsTheFourthPowerOfK) {
  for (const auto spectrum : kSpectra) {
    const OceanOptions o = with(spectrum);
    const double k = 50;
    const double ratio = ocean_spectrum(o, {4 * k, 0}) / ocean_spectrum(o, {k, 0});
    EXPECT_NEAR(std::log(ratio) / std::log(4.0), -4, 1e-3) << static_cast<int>(spectrum);
  }
}

/// Mean square of the coefficients of a ring of modes.
double ring_power(const Eigen::MatrixXcd& modes, int n, double radius) {
  double sum = 0;
  int count = 0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double k = std::hypot(waves_of(i, n), waves_of(j, n));
      if (std::abs(k - radius) > 0.5) continue;
      // Brought to the middle of the ring: the slope inside it would bias the mean.
      sum += std::norm(modes(j, i)) * std::pow(k / radius, 4);
      ++count;
    }
  }
  return sum / count;
}

// 30 seeds of rings of about 38 and 150 independent modes: 3 % and 1.5 %, in the slope 0.024.
TEST(OceanSpectrum, HeightsHaveTheTailOfTheirSpectrum) {
  for (const auto spectrum : {SpectrumKind::phillips, SpectrumKind::jonswap}) {
    OceanOptions o = with(spectrum);
    o.size = 60;  // 6 waves along it are k = 0.63 rad/m, 8 times the peak's w^2 and more
    o.wind_speed = 20;
    o.fetch = 1e6;
    o.samples = 64;
    double low = 0, high = 0;
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      const auto modes = ocean_modes(Ocean(o, seed).heights(0), 64);
      low += ring_power(modes, 64, 6);
      high += ring_power(modes, 64, 24);
    }
    EXPECT_NEAR(std::log(high / low) / std::log(4.0), -4, 0.1);
  }
}

// w H^(1/2) g^(-1/2) -> 0: k^-3 dk/dw over its deep value tends to (k H)^2 / 2; deep: 1.
TEST(OceanSpectrum, DepthLowersTheSpectrumByKitaigorodskiisFactor) {
  OceanOptions tma = with(SpectrumKind::tma), jonswap = with(SpectrumKind::jonswap);
  tma.depth = jonswap.depth = 1e-4;
  const Eigen::Vector2d k(100, 0);
  EXPECT_NEAR(ocean_spectrum(tma, k) / ocean_spectrum(jonswap, k) / (0.01 * 0.01 / 2), 1, 1e-4);
  tma.depth = jonswap.depth = 1000;
  EXPECT_EQ(ocean_spectrum(tma, k), ocean_spectrum(jonswap, k));
}

TEST(OceanSpectrum, SmallWavesAreDampedByOneOverE) {
  OceanOptions o = with(SpectrumKind::jonswap);
  const Eigen::Vector2d k(2 * pi / 5, 0);
  const double whole = ocean_spectrum(o, k);
  o.smallest_wave = 5;
  EXPECT_NEAR(ocean_spectrum(o, k) / whole, std::exp(-1), 1e-12);
}

}  // namespace
}  // namespace geoprior::fluid
