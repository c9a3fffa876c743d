#include "metrics/arrangement/angles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace geoprior {
namespace {

using Eigen::Vector3d;

Vector3d at_degrees(double angle) {
  const double a = angle * std::numbers::pi / 180;
  return {std::cos(a), std::sin(a), 0};
}

TEST(ArrangementAngles, AreExactToRoundOffAtBothEnds) {
  // The arc cosine of 1 - 1e-18 is 0: an angle of 1e-9 rad has to be measured otherwise.
  EXPECT_NEAR(angle_between({1, 0, 0}, {1, 1e-9, 0}), 1e-9 * 180 / std::numbers::pi, 1e-20);
  EXPECT_EQ(angle_between({2, 0, 0}, {-3, 0, 0}), 180);
  EXPECT_NEAR(angle_between({1, 0, 0}, at_degrees(37)), 37, 1e-13);
  EXPECT_EQ(angle_between({1, 0, 0}, {0, 0, 0}), 0);
}

TEST(ArrangementAngles, OfWallsDoNotDependOnTheWayThatTheyRun) {
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(right_angle_error({4, 0, 0}, sign * Vector3d(0, 2, 0)), 0);
    EXPECT_NEAR(right_angle_error({1, 0, 0}, sign * at_degrees(83)), 7, 1e-13);
    EXPECT_NEAR(right_angle_error({1, 0, 0}, sign * at_degrees(97)), 7, 1e-13);
  }
}

TEST(ArrangementAngles, TiltIsFromTheUpwardVertical) {
  EXPECT_EQ(tilt({3, 2, 1}, {3, 2, 4}), 0);
  EXPECT_NEAR(tilt({0, 0, 0}, {0, 1, 1}), 45, 1e-13);
  EXPECT_EQ(tilt({0, 0, 4}, {0, 0, 1}), 180);
}

}  // namespace
}  // namespace geoprior
