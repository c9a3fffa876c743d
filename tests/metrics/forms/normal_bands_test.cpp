#include "metrics/forms/normal_bands.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace geoprior {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Height a sin(2 pi k x) over the unit circle's cylinder would bend the normals too: a flat strip
/// that closes through infinity is enough here.
Eigen::MatrixX3d wave(double amplitude, int periods, double y, int n) {
  Eigen::MatrixX3d points(n, 3);
  for (int i = 0; i < n; ++i) {
    const double x = static_cast<double>(i) / n;
    points.row(i) << x, y, amplitude * std::sin(kTurn * periods * x);
  }
  return points;
}

TEST(CurveNormals, OfACylinderPointOutwards) {
  Eigen::MatrixX3d middle(360, 3), left(360, 3), right(360, 3);
  for (int i = 0; i < 360; ++i) {
    const double a = kTurn * i / 360;
    middle.row(i) << std::cos(a), std::sin(a), 0;
    left.row(i) << std::cos(a), std::sin(a), 0.1;
    right.row(i) << std::cos(a), std::sin(a), -0.1;
  }
  const Eigen::MatrixX3d normals = curve_normals(middle, left, right);
  for (int i = 0; i < 360; ++i) EXPECT_NEAR(normals.row(i).dot(middle.row(i)), 1, 1e-12);
}

TEST(CurveNormals, RefuseWhatHasNone) {
  EXPECT_THROW(curve_normals(wave(0, 1, 0, 2), wave(0, 1, 1, 2), wave(0, 1, -1, 2)), Error);
  EXPECT_THROW(curve_normals(wave(0, 1, 0, 8), wave(0, 1, 1, 7), wave(0, 1, -1, 8)), Error);
  EXPECT_THROW(curve_normals(wave(0, 1, 0, 8), wave(0, 1, 1, 8), wave(0, 1, 1, 8)), Error);
}

// 3 + cos + 2 sin of the seventh: 9 at zero, 1/2 and 2 in the bands of their numbers, nothing else.
TEST(BandPower, IsThatOfEachWave) {
  Eigen::MatrixX3d samples = Eigen::MatrixX3d::Zero(60, 3);
  for (int i = 0; i < 60; ++i) {
    samples(i, 0) = 3 + std::cos(kTurn * i / 60);
    samples(i, 2) = 2 * std::sin(kTurn * 7 * i / 60);
  }
  const std::array<double, 5> edges{0, 1, 6, 7, 30};
  const Eigen::VectorXd power = band_power(samples, edges);
  ASSERT_EQ(power.size(), 4);
  EXPECT_NEAR(power(0), 0.5, 1e-12);
  EXPECT_NEAR(power(1), 0, 1e-12);
  EXPECT_NEAR(power(2), 2, 1e-12);
  EXPECT_NEAR(power(3), 0, 1e-12);
  EXPECT_NEAR(power.sum() + 9, samples.rowwise().squaredNorm().mean(), 1e-12);
  EXPECT_THROW(band_power(samples, std::array{1., 1.}), Error);
  EXPECT_THROW(band_power(Eigen::MatrixX3d(0, 3), edges), Error);
}

TEST(LogSlope, IsTheExponentOfAPower) {
  const std::array<double, 4> x{1, 3, 10, 200};
  std::array<double, 4> y{};
  for (std::size_t i = 0; i < 4; ++i) y[i] = 5 * std::pow(x[i], -1.5);
  EXPECT_NEAR(log_slope(x, y), -1.5, 1e-12);
  EXPECT_THROW((void)log_slope(x, std::array{1., 0., 1., 1.}), Error);
  EXPECT_THROW((void)log_slope(std::array{1.}, std::array{1.}), Error);
}

}  // namespace
}  // namespace geoprior
