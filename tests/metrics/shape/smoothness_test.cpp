#include "metrics/shape/smoothness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "metrics/shape/distance.h"

namespace geoprior {
namespace {

std::vector<Eigen::MatrixX3d> sweep(int frames, const std::function<Eigen::Vector3d(int)>& at) {
  std::vector<Eigen::MatrixX3d> positions;
  for (int i = 0; i < frames; ++i) {
    Eigen::MatrixX3d V = Eigen::MatrixX3d::Zero(3, 3);
    V.row(1) = at(i).transpose();
    positions.push_back(V);
  }
  return positions;
}

std::vector<double> parameters(int frames, double step) {
  std::vector<double> p;
  for (int i = 0; i < frames; ++i) p.push_back(10 + step * i);
  return p;
}

TEST(SecondDifference, OfUniformMotionIsZero) {
  const auto p = sweep(6, [](int i) { return Eigen::Vector3d(0.25 * i, -0.5 * i, 2); });
  EXPECT_EQ(second_difference_max(p, parameters(6, 5)), 0);
}

TEST(SecondDifference, OfAParabolaIsItsAcceleration) {
  const auto p = sweep(5, [](int i) { return Eigen::Vector3d(0, 0.5 * i * i, 1.5 * i); });
  EXPECT_DOUBLE_EQ(second_difference_max(p, parameters(5, 0.1)), 1);
}

TEST(SecondDifference, OfARotationIsTwoRTimesOneMinusCos) {
  const double step = 0.1;
  const auto p = sweep(20, [&](int i) {
    return Eigen::Vector3d(3 * std::cos(step * i), 3 * std::sin(step * i), 0);
  });
  EXPECT_NEAR(second_difference_max(p, parameters(20, step)), 6 * (1 - std::cos(step)), 1e-14);
}

TEST(SecondDifference, OfAPopIsItsSize) {
  const auto jump = sweep(6, [](int i) { return Eigen::Vector3d(i < 3 ? 0 : 0.01, 0, 0); });
  EXPECT_DOUBLE_EQ(second_difference_max(jump, parameters(6, 5)), 0.01);
  const auto spike = sweep(6, [](int i) { return Eigen::Vector3d(i == 3 ? 0.01 : 0, 0, 0); });
  EXPECT_DOUBLE_EQ(second_difference_max(spike, parameters(6, 5)), 0.02);
  EXPECT_EQ(second_difference_max(jump, parameters(6, 5), {0, 2}), 0);
  EXPECT_EQ(second_difference_max(jump, parameters(6, 5), {1}), 0.01);
}

TEST(SecondDifference, NeedsEqualSteps) {
  const auto p = sweep(4, [](int) { return Eigen::Vector3d::Zero(); });
  EXPECT_THROW(second_difference_max(p, std::vector<double>{0, 1, 2, 4}), Error);
  EXPECT_THROW(second_difference_max(p, std::vector<double>{0, 1, 2}), Error);
  EXPECT_FALSE(equally_spaced(std::vector<double>{1, 1, 1}));
  EXPECT_TRUE(equally_spaced(std::vector<double>{3, 1}));
  // Steps of 0.1 are not equal in binary; they are within round-off.
  EXPECT_TRUE(equally_spaced(std::vector<double>{0, 0.1, 0.2, 0.30000000000000004}));
}

/// Positions along x(p) = 0.2 sin(p / 20) over 0 to 120, a kink and a jump of place as asked.
std::vector<Eigen::MatrixX3d> motion(double step, double kink = 0, double jump = 0) {
  return sweep(static_cast<int>(120 / step) + 1, [&](int i) {
    const double p = step * i;
    const double after = std::max(p - 61.25, 0.0);
    return Eigen::Vector3d(0.2 * std::sin(p / 20), kink * after, after > 0 ? jump : 0);
  });
}

MotionSmoothness smoothness_of(double step, const std::vector<Eigen::MatrixX3d>& positions) {
  return motion_smoothness(positions, parameters(static_cast<int>(positions.size()), step)).value();
}

TEST(MotionSmoothness, OfASmoothMotionIsItsSecondDerivativeAtAnyStep) {
  for (const double step : {1.0, 2.0, 5.0}) {
    const MotionSmoothness s = smoothness_of(step, motion(step));
    EXPECT_NEAR(s.velocity_change, 0.2 / 400, 0.03 * 0.2 / 400) << step;
    EXPECT_LE(s.jump, step * step * step * 0.2 / 8000 / 2 * 1.001) << step;
  }
}

TEST(MotionSmoothness, OfAJumpIsItsSizeAtAnyStep) {
  for (const double step : {1.0, 2.0, 5.0}) {
    const MotionSmoothness s = smoothness_of(step, motion(step, 0, 0.01));
    EXPECT_NEAR(s.jump, 0.01, 0.0003) << step;
    EXPECT_NEAR(s.velocity_change, 0.01 / (step * step), 0.02 * 0.01 / (step * step) + 0.2 / 400)
        << step;
  }
}

TEST(MotionSmoothness, OfAKinkGrowsAsTheStepFalls) {
  // The kink is a quarter of a step of 5 after a frame: the largest change of velocity is 3/4 of
  // it.
  const double kink = 0.01;
  EXPECT_NEAR(smoothness_of(5, motion(5, kink)).velocity_change, 0.75 * kink / 5, 2e-4);
  EXPECT_GT(smoothness_of(1, motion(1, kink)).velocity_change, 0.7 * kink);
  EXPECT_LT(smoothness_of(1, motion(1, kink)).jump, kink);
}

TEST(MotionSmoothness, UnequalAndFallingStepsAreTaken) {
  const std::vector<double> p{0, 1, 3, 4, 8, 9};
  std::vector<Eigen::MatrixX3d> positions;
  for (const double at : p) positions.push_back(Eigen::MatrixX3d::Constant(1, 3, at * at));
  // Divided differences are exact for a parabola.
  EXPECT_NEAR(motion_smoothness(positions, p)->velocity_change, 2 * std::sqrt(3.0), 1e-12);
  const std::vector<double> falling{9, 8, 6, 5, 1, 0};
  EXPECT_NEAR(motion_smoothness(positions, falling)->velocity_change, 2 * std::sqrt(3.0), 1e-12);
  EXPECT_THROW((void)motion_smoothness(positions, std::vector<double>{0, 1, 3, 3, 8, 9}), Error);
  EXPECT_THROW((void)motion_smoothness(positions, std::vector<double>{0, 1}), Error);
  positions.resize(3);
  EXPECT_FALSE(motion_smoothness(positions, std::vector<double>{0, 1, 2}).has_value());
}

TEST(VertexDistance, OfAShiftIsItsLength) {
  Eigen::MatrixX3d a = Eigen::MatrixX3d::Random(10, 3);
  Eigen::MatrixX3d b = a;
  b.row(4) += Eigen::RowVector3d(0.3, 0, 0.4);
  const VertexDistance d = vertex_distance(a, b);
  EXPECT_NEAR(d.max, 0.5, 1e-15);
  EXPECT_NEAR(d.rms, 0.5 / std::sqrt(10.0), 1e-15);
  EXPECT_EQ(vertex_distance(a, b, {0, 1}).max, 0);
  EXPECT_NEAR(vertex_distance(a, b, {3, 4}).rms, 0.5 / std::sqrt(2.0), 1e-15);
  EXPECT_THROW(vertex_distance(a, b.topRows(3)), Error);
}

}  // namespace
}  // namespace geoprior
