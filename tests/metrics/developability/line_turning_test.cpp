#include "metrics/developability/line_turning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace geoprior {
namespace {

constexpr double kPi = std::numbers::pi;

Eigen::MatrixX3d circle(int count, double radius) {
  Eigen::MatrixX3d points(count, 3);
  for (int i = 0; i < count; ++i) {
    const double a = 2 * kPi * i / count;
    points.row(i) << radius * std::cos(a), 2, radius * std::sin(a);
  }
  return points;
}

TEST(LineTurning, OfAConvexCurveIsAFullTurn) {
  for (const int count : {4, 17, 200}) {
    const LineTurning turning = line_turning(circle(count, 0.3), true);
    EXPECT_NEAR(turning.turning, 2 * kPi, 1e-12) << count;
    EXPECT_NEAR(turning.length, 2 * count * 0.3 * std::sin(kPi / count), 1e-12);
  }
}

// Of a helix of radius r that rises by 2 pi c a turn, the curvature r / (r^2 + c^2) over the
// length.
TEST(LineTurning, OfAHelixIsItsCurvatureTimesItsLength) {
  constexpr int kCount = 4000;
  const double r = 0.5, c = 0.2;
  Eigen::MatrixX3d points(kCount + 1, 3);
  for (int i = 0; i <= kCount; ++i) {
    const double a = 6 * kPi * i / kCount;
    points.row(i) << r * std::cos(a), c * a, r * std::sin(a);
  }
  const LineTurning turning = line_turning(points, false);
  EXPECT_NEAR(turning.turning, r / (r * r + c * c) * turning.length, 1e-2);
}

TEST(LineTurning, OfAStraightLineIsNothingAndOfAZigzagItsCorners) {
  Eigen::MatrixX3d straight(5, 3), zigzag(11, 3);
  for (int i = 0; i < 5; ++i) straight.row(i) << 0.1 * i, 0.2 * i, -0.3 * i;
  EXPECT_NEAR(line_turning(straight, false).turning, 0, 1e-7);
  for (int i = 0; i < 11; ++i) zigzag.row(i) << i, i % 2, 0;
  const LineTurning turning = line_turning(zigzag, false);
  EXPECT_NEAR(turning.turning, 9 * kPi / 2, 1e-12);
  EXPECT_NEAR(turning.length, 10 * std::sqrt(2.0), 1e-12);
}

// Circles of a sphere: 2 pi cos t at the angle t from the pole, nothing along the equator.
TEST(LineTurning, WithinASphereIsThatOfGeodesicCurvature) {
  constexpr int kCount = 400;
  for (const double t : {0.3, 1.0, kPi / 2}) {
    Eigen::MatrixX3d normals(kCount, 3);
    for (int i = 0; i < kCount; ++i) {
      const double a = 2 * kPi * i / kCount;
      normals.row(i) << std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t);
    }
    const LineTurning turning = line_turning_within(0.2 * normals, normals, true);
    EXPECT_NEAR(turning.turning, 2 * kPi * std::cos(t), 1e-3) << t;
    EXPECT_NEAR(turning.length, 0.4 * kPi * std::sin(t), 1e-4) << t;
  }
}

TEST(LineTurning, OfNothingIsNothing) {
  EXPECT_EQ(line_turning(Eigen::MatrixX3d(0, 3), true).turning, 0);
  EXPECT_EQ(line_turning(Eigen::MatrixX3d::Ones(1, 3), false).length, 0);
}

}  // namespace
}  // namespace geoprior
