#include "metrics/forms/window_forms.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace geoprior {
namespace {

/// One window of the graph (x, y, sin(2 pi x) / 2 pi): E = 1 + cos^2, F = 0, G = 1.
Eigen::MatrixX3d wave_window(double corner, int side, double step) {
  Eigen::MatrixX3d points(side * side, 3);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const double x = corner + step * i;
      points.row(j * side + i) << x, step * j,
          std::sin(2 * std::numbers::pi * x) / (2 * std::numbers::pi);
    }
  return points;
}

TEST(WindowForms, AreThoseOfAWaveAtFortyPointsAPeriod) {
  const int side = 9;
  const double step = 1. / 40, corner = -0.1;
  const auto forms =
      window_forms(wave_window(corner, side, step), side, step, DifferenceOrder::fourth);
  ASSERT_EQ(forms.size(), 25u);
  for (int i = 0; i < 5; ++i) {
    const double slope = std::cos(2 * std::numbers::pi * (corner + step * (i + 2)));
    EXPECT_NEAR(forms[i].E, 1 + slope * slope, 1e-4);
    EXPECT_NEAR(forms[i].F, 0, 1e-12);
    EXPECT_NEAR(forms[i].G, 1, 1e-12);
  }
}

TEST(WindowForms, SecondOrderFallsShortByASixthOfTheSquare) {
  for (const int samples : {8, 16, 32}) {
    const double step = 1. / samples;
    const auto forms = window_forms(wave_window(-step, 3, step), 3, step, DifferenceOrder::second);
    const double slope = std::sqrt(forms.at(0).E - 1);  // 1 at the middle
    const double angle = 2 * std::numbers::pi * step;
    EXPECT_NEAR(slope, std::sin(angle) / angle, 1e-12) << samples;
  }
}

TEST(WindowForms, NormIsThatOfTheMatrix) {
  EXPECT_DOUBLE_EQ((FundamentalForm{3, 2, -1} - FundamentalForm{1, 0, 0}).norm(),
                   std::sqrt(4 + 8 + 1.));
}

TEST(WindowForms, RefusesWhatIsNoWindow) {
  EXPECT_THROW(window_forms(Eigen::MatrixX3d(10, 3), 3, 1, DifferenceOrder::second), Error);
  EXPECT_THROW(window_forms(Eigen::MatrixX3d(16, 3), 4, 1, DifferenceOrder::fourth), Error);
}

TEST(ClosedCurveLength, OfACircleIsOfFourthOrder) {
  const auto error = [](int n) {
    Eigen::MatrixX3d circle(n, 3);
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      circle.row(i) << std::cos(angle), std::sin(angle), 0;
    }
    return std::abs(closed_curve_length(circle) - 2 * std::numbers::pi);
  };
  EXPECT_NEAR(std::log2(error(16) / error(32)), 4, 0.1);
  EXPECT_LT(error(64), 1e-4);
  EXPECT_THROW(closed_curve_length(Eigen::MatrixX3d(5, 3)), Error);
}

}  // namespace
}  // namespace geoprior
