#include "models/embryo/motion/monotone.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"

namespace geoprior::embryo {
namespace {

MonotoneCurve curve_of(const std::vector<double>& days, const std::vector<double>& values,
                       Ends ends = Ends::fading,
                       Interpolation interpolation = Interpolation::monotone) {
  return {days, Eigen::VectorXd::Map(values.data(), std::ssize(values)), interpolation, ends};
}

/// One-sided velocities of a cubic, by differences that are exact for it.
double curve_speed_after(const MonotoneCurve& curve, double day) {
  const double h = 1e-4;
  return (-11 * curve.at(day)[0] + 18 * curve.at(day + h)[0] - 9 * curve.at(day + 2 * h)[0] +
          2 * curve.at(day + 3 * h)[0]) /
         (6 * h);
}
double curve_speed_before(const MonotoneCurve& curve, double day) {
  const double h = 1e-4;
  return (11 * curve.at(day)[0] - 18 * curve.at(day - h)[0] + 9 * curve.at(day - 2 * h)[0] -
          2 * curve.at(day - 3 * h)[0]) /
         (6 * h);
}

TEST(MonotoneCurve, GoesThroughItsKeysBitForBit) {
  const MonotoneCurve curve = curve_of({28, 29.5, 33, 36.1}, {0.1, 0.7, 0.65, 0.3});
  EXPECT_EQ(curve.at(28)[0], 0.1);
  EXPECT_EQ(curve.at(29.5)[0], 0.7);
  EXPECT_EQ(curve.at(33)[0], 0.65);
  EXPECT_EQ(curve.at(36.1)[0], 0.3);
}

TEST(MonotoneCurve, StaysOnALineThroughUnevenKeys) {
  const MonotoneCurve curve = curve_of({0, 1, 4, 4.5}, {1, 3, 9, 10});
  for (double day = 0; day <= 4.5; day += 0.11) EXPECT_NEAR(curve.at(day)[0], 1 + 2 * day, 1e-13);
}

/// A cubic spline through these keys swings below 0 and above 1.
TEST(MonotoneCurve, NeverLeavesTheRangeOfTwoKeys) {
  const MonotoneCurve curve = curve_of({0, 1, 2, 3, 4, 5}, {0, 0, 0, 1, 1, 1});
  double before = 0;
  for (double day = 0; day <= 5; day += 0.01) {
    const double value = curve.at(day)[0];
    EXPECT_GE(value, before);
    EXPECT_LE(value, 1);
    before = value;
  }
}

/// Fritsch and Carlson's data RPN 14, on which a cubic spline swings between the first keys.
TEST(MonotoneCurve, RisesThroughTheDataOfFritschAndCarlson) {
  const std::vector<double> days{7.99, 8.09, 8.19, 8.7, 9.2, 10, 12, 15, 20};
  const std::vector<double> values{0,        2.76429e-5, 4.37498e-2, 0.169183, 0.469428,
                                   0.943740, 0.998636,   0.999919,   0.999994};
  const MonotoneCurve curve = curve_of(days, values);
  double before = -1e-15;
  for (double day = 7.99; day <= 20; day += 0.01) {
    EXPECT_GE(curve.at(day)[0], before) << day;
    before = curve.at(day)[0];
  }
}

TEST(MonotoneCurve, HasOneVelocityOnBothSidesOfEveryKey) {
  const std::vector<double> days{0, 1, 3, 3.5, 6};
  for (const Ends ends : {Ends::rest, Ends::fading}) {
    const MonotoneCurve curve = curve_of(days, {0, 2, 2.5, 4, 3}, ends);
    for (const double day : days)
      EXPECT_NEAR(curve_speed_after(curve, day), curve_speed_before(curve, day), 1e-7) << day;
  }
}

TEST(MonotoneCurve, RestsBeforeAndAfterItsKeysOrFadesByAtMostTheLastIntervalsWay) {
  const MonotoneCurve rest = curve_of({0, 2}, {1, 5}, Ends::rest);
  EXPECT_EQ(rest.at(-3)[0], 1);
  EXPECT_EQ(rest.at(9)[0], 5);
  EXPECT_NEAR(rest.at(1)[0], 3, 1e-15);
  const MonotoneCurve fading = curve_of({0, 2}, {1, 5});
  EXPECT_NEAR(fading.at(3)[0], 5 + 2 * 2 * (1 - std::exp(-0.5)), 1e-14);
  EXPECT_NEAR(fading.at(-1)[0], 1 - 2 * 2 * (1 - std::exp(-0.5)), 1e-14);
  EXPECT_LT(fading.at(1000)[0], 9 + 1e-12);
}

TEST(MonotoneCurve, IsStraightWhereItIsLinear) {
  const MonotoneCurve curve = curve_of({0, 1, 3}, {0, 1, 0}, Ends::fading, Interpolation::linear);
  EXPECT_NEAR(curve.at(0.25)[0], 0.25, 1e-15);
  EXPECT_NEAR(curve.at(2)[0], 0.5, 1e-15);
  EXPECT_EQ(curve.at(7)[0], 0);
}

TEST(MonotoneCurve, RefusesDaysOutOfOrderAndNumbersThatAreNone) {
  EXPECT_THROW(curve_of({0, 0}, {1, 2}), Error);
  EXPECT_THROW(curve_of({}, {}), Error);
  EXPECT_THROW(curve_of({0, 1}, {1, std::nan("")}), Error);
}

}  // namespace
}  // namespace geoprior::embryo
