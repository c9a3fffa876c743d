#include "metrics/shape/second_differences.h"

#include <gtest/gtest.h>

#include <cmath>

namespace geoprior {
namespace {

/// A point that falls freely has x'' dt^2 in every frame, whatever the quantile.
TEST(SecondDifferences, OfFreeFallAreTheAccelerationTimesTheStepSquared) {
  constexpr double kStep = 0.04, kGravity = 9.81;
  SecondDifferences differences;
  for (int i = 0; i < 6; ++i) {
    const double t = i * kStep;
    differences.add(Eigen::RowVector3d(0.3, t, -kGravity / 2 * t * t));
  }
  for (const int percent : {0, 50, 95})
    EXPECT_NEAR(differences.quantile(percent).value(), kGravity * kStep * kStep, 1e-15);
}

/// One point of twenty that jumps is beyond the 95th percentile of three frames, and below it when
/// every point jumps.
TEST(SecondDifferences, AQuantileIsBlindToAPopOfFewPoints) {
  const auto p95 = [](int jumping) {
    SecondDifferences differences;
    for (int i = 0; i < 3; ++i) {
      Eigen::MatrixX3d x = Eigen::MatrixX3d::Zero(40, 3);
      if (i == 2) x.topRows(jumping).col(2).setConstant(0.01);
      differences.add(x);
    }
    return differences.quantile(95).value();
  };
  EXPECT_EQ(p95(1), 0);
  EXPECT_DOUBLE_EQ(p95(40), 0.01);
}

TEST(SecondDifferences, OfNothingAreAbsent) {
  SecondDifferences two_frames, no_points;
  for (int i = 0; i < 2; ++i) two_frames.add(Eigen::RowVector3d(0, 0, i));
  for (int i = 0; i < 4; ++i) no_points.add(Eigen::MatrixX3d(0, 3));
  EXPECT_FALSE(SecondDifferences().quantile(95));
  EXPECT_FALSE(two_frames.quantile(95));
  EXPECT_FALSE(no_points.quantile(95));
}

}  // namespace
}  // namespace geoprior
