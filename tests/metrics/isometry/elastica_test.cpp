#include "metrics/isometry/elastica.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"

namespace geoprior {
namespace {

/// The strip itself: theta'' = -load sin(theta) over arc length 1, theta(0) = `slope`, theta'(0) =
/// 0 (no moment at a pinned end), by Runge-Kutta; the load makes theta(1/2) = 0.
struct Integrated {
  double theta = 0, x = 0, y = 0;  ///< at the middle
};
Integrated half_strip(double slope, double load) {
  constexpr int kSteps = 2000;
  const double h = 0.5 / kSteps;
  Integrated s{slope, 0, 0};
  double curvature = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t0 = s.theta, c0 = curvature;
    const double t1 = t0 + h / 2 * c0, c1 = c0 - h / 2 * load * std::sin(t0);
    const double t2 = t0 + h / 2 * c1, c2 = c0 - h / 2 * load * std::sin(t1);
    const double t3 = t0 + h * c2, c3 = c0 - h * load * std::sin(t2);
    const double middle = (t1 + t2) / 2;
    s.theta += h / 6 * (c0 + 2 * c1 + 2 * c2 + c3);
    curvature -= h / 6 * load * (std::sin(t0) + 2 * std::sin(t1) + 2 * std::sin(t2) + std::sin(t3));
    s.x += h / 6 * (std::cos(t0) + 4 * std::cos(middle) + std::cos(s.theta));
    s.y += h / 6 * (std::sin(t0) + 4 * std::sin(middle) + std::sin(s.theta));
  }
  return s;
}

TEST(Elastica, AgreesWithTheStripsDifferentialEquation) {
  for (const double slope : {0.3, 1.0, 1.5, 2.2}) {
    double low = 9;  // Euler's load is pi^2
    double high = 40;
    for (int i = 0; i < 60; ++i) {
      const double load = (low + high) / 2;
      (half_strip(slope, load).theta > 0 ? low : high) = load;
    }
    const Integrated middle = half_strip(slope, (low + high) / 2);
    EXPECT_NEAR(elastica_height(1, 2 * middle.x), middle.y, 1e-8) << slope;
  }
}

TEST(Elastica, OfASmallShorteningIsASine) {
  for (const double shortening : {1e-3, 1e-5}) {
    const double sine = 2 / std::numbers::pi * std::sqrt(shortening);
    // The next term of the series is 5/8 of the shortening, relative.
    EXPECT_NEAR(elastica_height(1, 1 - shortening) / sine, 1, shortening);
  }
  EXPECT_NEAR(elastica_height(0.2, 0.2), 0, 1e-9);
}

TEST(Elastica, ScalesWithItsLength) {
  EXPECT_NEAR(elastica_height(0.3, 0.21), 0.3 * elastica_height(1, 0.7), 1e-14);
}

TEST(Elastica, RefusesEndsFartherApartThanTheStripIsLong) {
  EXPECT_THROW(elastica_height(0.2, 0.21), Error);
  EXPECT_THROW(elastica_height(0.2, -0.01), Error);
  EXPECT_THROW(elastica_height(0, 0), Error);
}

TEST(EllipticIntegrals, HaveTheirTabulatedValues) {
  // Abramowitz and Stegun, table 17.1, m = k^2 = 0.5 and 0.
  const EllipticIntegrals half = elliptic_integrals(std::sqrt(0.5));
  EXPECT_NEAR(half.first, 1.854074677301372, 1e-14);
  EXPECT_NEAR(half.second, 1.350643881047675, 1e-14);
  EXPECT_NEAR(elliptic_integrals(0).first, std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(elliptic_integrals(0).second, std::numbers::pi / 2, 1e-15);
  // Legendre's relation, E K' + E' K - K K' = pi / 2.
  const EllipticIntegrals a = elliptic_integrals(0.6);
  const EllipticIntegrals b = elliptic_integrals(0.8);
  EXPECT_NEAR(a.second * b.first + b.second * a.first - a.first * b.first, std::numbers::pi / 2,
              1e-14);
  EXPECT_THROW(elliptic_integrals(1), Error);
}

/// Half a circle of radius r stands r over its diameter 2 r, wherever it is and however it is
/// turned.
TEST(StripRise, OfAHalfCylinderIsItsRadius) {
  constexpr double kRadius = 0.03;
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 2) / 3, along = Eigen::Vector3d(2, 1, -2) / 3;
  std::vector<BentLine> lines;
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d centre = 0.01 * i * axis + Eigen::Vector3d(0.1, 0, 0);
    lines.push_back(
        {centre - kRadius * along, centre + kRadius * axis.cross(along), centre + kRadius * along});
  }
  const StripRise rise = strip_rise(lines);
  EXPECT_NEAR(rise.distance, 2 * kRadius, 1e-15);
  EXPECT_NEAR(rise.height, kRadius, 1e-15);
}

TEST(StripBetween, IsBetweenOppositeSidesOfAWholeRectangle) {
  const Strip::Side left{Eigen::Vector2d(0, 0), Eigen::Vector2d(0, 0.1)},
      down{Eigen::Vector2d(0.3, 0.1), Eigen::Vector2d(0.3, 0)};
  const auto strip = strip_between(left, down, 0.03);
  ASSERT_TRUE(strip);
  EXPECT_NEAR(strip->length(), 0.3, 1e-15);
  EXPECT_LT((strip->at(0.25, 0.5) - Eigen::Vector2d(0.15, 0.025)).norm(), 1e-15);
  // A sheet that goes on beyond, a parallelogram, sides of unequal length.
  EXPECT_FALSE(strip_between(left, down, 0.031));
  EXPECT_FALSE(strip_between(left, {Eigen::Vector2d(0.3, 0.05), Eigen::Vector2d(0.3, 0.15)}, 0.03));
  EXPECT_FALSE(strip_between(left, {Eigen::Vector2d(0.3, 0), Eigen::Vector2d(0.3, 0.09)}, 0.03));
}

}  // namespace
}  // namespace geoprior
