#include "metrics/volume/slosh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace geoprior {
namespace {

using std::numbers::pi;

// h = H + A cos(pi x / L) at midpoints: discrete cosines are orthogonal, so the amplitude is exact.
TEST(SloshAmplitude, OfTheFirstModeIsItsAmplitudeAndOfTheSecondZero) {
  const ColumnGrid grid{{0, 0}, 0.1, 10, 3};
  Columns first, second;
  first.top.resize(grid.count());
  second.top.resize(grid.count());
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const double x = grid.probe(i, j).x();
      first.top[grid.index(i, j)] = 0.4 + 0.03 * std::cos(pi * x);
      second.top[grid.index(i, j)] = 0.4 + 0.03 * std::cos(2 * pi * x);
    }
  }
  EXPECT_NEAR(slosh_amplitude(first, grid), 0.03, 1e-15);
  EXPECT_NEAR(slosh_amplitude(second, grid), 0, 1e-15);
}

TEST(CrossingFrequency, OfADampedSwing) {
  std::vector<double> times, values;
  for (int i = 0; i <= 400; ++i) {
    times.push_back(0.025 * i);
    values.push_back(std::exp(-0.05 * times.back()) * std::cos(5 * times.back()));
  }
  // Linear interpolation of a cosine near its zero is exact to (w dt)^3 / 50 of a step; the mean of
  // a damped swing is not quite 0, which moves crossings to and fro.
  EXPECT_NEAR(crossing_frequency(times, values), 5, 5e-3);
  EXPECT_EQ(crossing_frequency({0, 1}, {1, 1}), 0);
}

// Deep and shallow limits: sqrt(g k) and k sqrt(g H).
TEST(SloshFrequency, HasTheLimitsOfDeepAndShallowWater) {
  EXPECT_NEAR(slosh_frequency(1, 100, 9.81), std::sqrt(9.81 * pi), 1e-12);
  EXPECT_NEAR(slosh_frequency(1, 1e-3, 9.81), pi * std::sqrt(9.81e-3), 1e-5);
}

// Two metres of water that swing four times, at 1.1 times the frequency of linear theory. The
// sample that is one too many moves the mean by 1/401 of the amplitude, and crossings by as many
// radians.
TEST(SloshFrequencyError, IsWhatTheSwingIsOff) {
  const ColumnGrid grid{{0, 0}, 0.1, 10, 1};
  const double frequency = 1.1 * slosh_frequency(1, 2, 9.81);
  std::vector<double> times;
  std::vector<Columns> water;
  for (int t = 0; t <= 400; ++t) {
    times.push_back(2 * pi / frequency * t / 100);
    Columns& at = water.emplace_back();
    at.top.resize(grid.count());
    at.depth = Eigen::VectorXd::Constant(grid.count(), 2);
    for (int i = 0; i < grid.nx; ++i) {
      at.top[i] =
          2 + 0.01 * std::cos(pi * grid.probe(i, 0).x()) * std::cos(frequency * times.back());
    }
  }
  EXPECT_NEAR(slosh_frequency_error(times, water, grid, 1, 9.81).value(), 0.1, 1e-3);
  EXPECT_FALSE(slosh_frequency_error({}, {}, grid, 1, 9.81));
  EXPECT_FALSE(slosh_frequency_error({0, 1}, {water[0], water[0]}, grid, 1, 9.81));
}

}  // namespace
}  // namespace geoprior
