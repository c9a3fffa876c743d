#include "metrics/tracks/velocity_jump.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/error.h"

namespace geoprior {
namespace {

constexpr double kJumpStep = 1.0 / 8192;

/// Two points, one at rest, over [0, 2], with the five samples at 1.
SampledMotion jump_motion(const std::function<double(double)>& way) {
  SampledMotion motion;
  for (const double t :
       {0.0, 0.5, 1 - 2 * kJumpStep, 1 - kJumpStep, 1.0, 1 + kJumpStep, 1 + 2 * kJumpStep, 2.0}) {
    motion.parameters.push_back(t);
    motion.x.emplace_back(Eigen::MatrixXd::Zero(2, 3));
    motion.x.back().row(1) << way(t), 2 * way(t), 2 * way(t);
  }
  return motion;
}

/// x' is 1 at the border on both sides, x'' is 3 before it and -5 after it.
TEST(VelocityJump, IsZeroOfTwoParabolasThatJoinWithOneTangent) {
  const SampledMotion motion = jump_motion([](double t) {
    const double u = t - 1;
    return 10 + u + (u < 0 ? 1.5 : -2.5) * u * u;
  });
  EXPECT_LT(velocity_jump(motion, 1, kJumpStep).value(), 1e-10);
}

/// |(1, 2, 2)| = 3 times the change of slope from 2 to -0.5.
TEST(VelocityJump, OfAPolylineIsTheChangeOfItsSlope) {
  const SampledMotion motion =
      jump_motion([](double t) { return t < 1 ? 2 * (t - 1) : -0.5 * (t - 1); });
  EXPECT_NEAR(velocity_jump(motion, 1, kJumpStep).value(), 7.5, 1e-9);
}

/// h^2/3 times the jump of the third derivative, here 6 (4 + 7), is what is left of a C1 motion.
TEST(VelocityJump, LeavesOfThirdDerivativesOnlyTheirJumpTimesTheStepSquared) {
  const double step = 1.0 / 64;
  SampledMotion motion;
  for (int k = -2; k <= 2; ++k) {
    const double t = k * step;
    motion.parameters.push_back(t);
    motion.x.emplace_back(Eigen::MatrixXd::Constant(1, 1, (t < 0 ? 4 : -7) * t * t * t));
  }
  EXPECT_NEAR(velocity_jump(motion, 0, step).value(), step * step / 3 * 66, 1e-12);
}

TEST(VelocityJump, SeesAKinkOfAMillionthOfTheSpeed) {
  const SampledMotion motion =
      jump_motion([](double t) { return std::sin(t) + (t < 1 ? 0 : 1e-6) * (t - 1); });
  EXPECT_NEAR(velocity_jump(motion, 1, kJumpStep).value(), 3e-6, 3e-8);
}

/// The way of the moving point is 3 * 2, that of the other 0, over 2: mean speed 1.5.
TEST(VelocityJump, IsRelativeToTheMeanSpeedOfAllRows) {
  const SampledMotion motion = jump_motion([](double t) { return std::abs(t - 1); });
  EXPECT_NEAR(mean_speed(motion), 1.5, 1e-12);
  const std::vector<double> at{0.5, 1.0};
  EXPECT_NEAR(relative_velocity_jump(motion, at, kJumpStep).value(), 6 / 1.5, 1e-9);
}

TEST(VelocityJump, OfWhatRestsIsZeroAndOfWhatIsNotSampledAbsent) {
  const SampledMotion motion = jump_motion([](double) { return 3.0; });
  const std::vector<double> there{1.0}, nowhere{0.5};
  EXPECT_EQ(relative_velocity_jump(motion, there, kJumpStep), 0.0);
  EXPECT_FALSE(relative_velocity_jump(motion, nowhere, kJumpStep));
  EXPECT_FALSE(relative_velocity_jump(motion, there, 2 * kJumpStep));
}

TEST(VelocityJump, RefusesSamplesOutOfOrder) {
  SampledMotion motion = jump_motion([](double t) { return t; });
  std::swap(motion.parameters[0], motion.parameters[1]);
  EXPECT_THROW(velocity_jump(motion, 1, kJumpStep), Error);
}

}  // namespace
}  // namespace geoprior
