#include "solvers/torus/jets/jet.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "solvers/torus/jets/corrugated_jet.h"

namespace geoprior::torus {
namespace {

constexpr int kOrder = 5;

Jet<kOrder> drawn_jet(RandomStream& random, double first) {
  Jet<kOrder> jet;
  for (Lane& c : jet.c)
    for (int l = 0; l < 4; ++l) c[l] = random.uniform() - 0.5;
  jet.c[0] = Lane::Constant(first);
  return jet;
}

/// Value of the polynomial in the first lane.
double at(const Jet<kOrder>& jet, double x, double y) {
  double sum = 0;
  for (int p = 0; p <= kOrder; ++p)
    for (int j = 0; j <= p; ++j)
      sum += jet.c[monomial(p, j)][0] * std::pow(x, p - j) * std::pow(y, j);
  return sum;
}

/// What is left of two functions that agree up to the order falls with its next power.
double order_of(const std::function<double(double)>& difference) {
  return std::log2(std::abs(difference(0.08) / difference(0.04)));
}

TEST(Jet, ProductsPowersAndRootsAgreeUpToTheirOrder) {
  RandomStream random(1, "jets");
  const auto a = drawn_jet(random, 1.3), b = drawn_jet(random, 0.7);
  const auto product = a * b, root = sqrt(a), inverted_a = inverse(a);
  const auto error = [&](auto f, const Jet<kOrder>& jet) {
    return order_of([&](double h) { return f(at(a, h, -h), at(b, h, -h)) - at(jet, h, -h); });
  };
  EXPECT_NEAR(error([](double x, double y) { return x * y; }, product), kOrder + 1, 0.4);
  EXPECT_NEAR(error([](double x, double) { return std::sqrt(x); }, root), kOrder + 1, 0.4);
  EXPECT_NEAR(error([](double x, double) { return 1 / x; }, inverted_a), kOrder + 1, 0.4);
}

TEST(Jet, DerivativesAreThoseOfThePolynomial) {
  RandomStream random(2, "jets");
  const auto a = drawn_jet(random, 1);
  const Jet<kOrder - 1> x = derivative_x(a), y = derivative_y(a);
  const double h = 1e-4;
  EXPECT_NEAR(x.value()[0], (at(a, h, 0) - at(a, -h, 0)) / (2 * h), 1e-7);
  EXPECT_NEAR(y.value()[0], (at(a, 0, h) - at(a, 0, -h)) / (2 * h), 1e-7);
  EXPECT_NEAR(derivative_y(x).value()[0],
              (at(a, h, h) - at(a, h, -h) - at(a, -h, h) + at(a, -h, -h)) / (4 * h * h), 1e-6);
}

TEST(Jet, InvertedSeriesOfTheSineIsThatOfTheArcSine) {
  Series<5> sine;  // about 0: x - x^3/6 + x^5/120
  const double coefficients[] = {0, 1, 0, -1. / 6, 0, 1. / 120};
  for (int k = 0; k <= 5; ++k) sine[k] = Lane::Constant(coefficients[k]);
  const Series<5> inverse = inverted<5>(sine, Lane::Zero());
  const double wanted[] = {0, 1, 0, 1. / 6, 0, 3. / 40};
  for (int k = 0; k <= 5; ++k) EXPECT_NEAR(inverse[k][2], wanted[k], 1e-15) << k;
}

TEST(Jet, PowersOfALinearFunction) {
  Series<3> cube;
  for (int k = 0; k <= 3; ++k) cube[k] = Lane::Constant(k == 3 ? 1 : 0);
  const Jet<3> jet = LinearPowers<3>({2, -1}).compose(cube);  // (2x - y)^3
  const double wanted[] = {8, -12, 6, -1};
  for (int j = 0; j <= 3; ++j) EXPECT_EQ(jet.c[monomial(3, j)][0], wanted[j]);
}

TEST(Bessel, FunctionsAndInverseAreThoseOfTheStandardLibrary) {
  Lane amplitude;
  amplitude << 0.01, 0.7, 1.9, 2.4048;
  const auto j = bessel_functions<20>(amplitude);
  for (int n = 0; n < 20; ++n)
    for (int l = 0; l < 4; ++l)
      EXPECT_NEAR(j[n][l], std::cyl_bessel_j(n, amplitude[l]), 4e-16) << n << " " << amplitude[l];
  const Lane again = inverse_bessel(j[0]);
  for (int l = 1; l < 4; ++l) EXPECT_NEAR(again[l], amplitude[l], 1e-14);
  EXPECT_NEAR(again[0], amplitude[0], 1e-12) << "J_0 is flat there";
}

TEST(Bessel, SeriesAreTaylorsAboutTheAmplitude) {
  const double a = 1.4, h = 0.05;
  const auto series = bessel_series<4>(Lane::Constant(a));
  for (const int n : {0, 1, 5}) {
    double sum = 0;
    for (int k = 4; k >= 0; --k) sum = sum * h + series[n][k][0];
    EXPECT_NEAR(sum, std::cyl_bessel_j(n, a + h), 1e-8) << n;
  }
}

TEST(LoopIntegrals, AreTheIntegralsOfTheLoopWithoutItsMean) {
  const double amplitude = 2.1, s = 0.37;
  const auto loops =
      loop_integrals<0>(bessel_series<0>(Lane::Constant(amplitude)),
                        Jet<0>::constant(Lane::Constant(amplitude)), Lane::Constant(s), {1, 0});
  constexpr int kSteps = 20000;  // midpoint rule
  double cosine = 0, sine = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double u = s * (i + 0.5) / kSteps;
    const double angle = amplitude * std::cos(2 * std::numbers::pi * u);
    cosine += (std::cos(angle) - std::cyl_bessel_j(0, amplitude)) * s / kSteps;
    sine += std::sin(angle) * s / kSteps;
  }
  EXPECT_NEAR(loops.cosine.value()[0], cosine, 1e-8);
  EXPECT_NEAR(loops.sine.value()[0], sine, 1e-8);
}

TEST(Wave, IsThatOfTheStandardLibrary) {
  for (const double s : {0., 0.1, 0.25, 0.49999, -0.3, 7.8}) {
    const Wave at_s = wave(Lane::Constant(s));
    EXPECT_NEAR(at_s.sine[0], std::sin(2 * std::numbers::pi * s), 4e-15) << s;
    EXPECT_NEAR(at_s.cosine[0], std::cos(2 * std::numbers::pi * s), 4e-15) << s;
  }
}

}  // namespace
}  // namespace geoprior::torus
