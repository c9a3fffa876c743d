#include "models/embryo/motion/key_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "metrics/tracks/velocity_jump.h"

namespace geoprior::embryo {
namespace {

const std::vector<double> kPathDays{1, 2, 4, 5, 9};
const std::vector<Eigen::Vector3d> kPathPlaces{
    {0.1, 0, 0}, {0.1, 0.1, 0}, {0.15, 0.2, 0.1}, {0.3, 0.2, 0.15}, {0.3, 0.25, 0.3}};

SampledMotion sampled_path(const KeyPath& path, double from, double to,
                           const std::vector<double>& borders, double step) {
  SampledMotion motion;
  for (double day = from; day <= to; day += 0.25) motion.parameters.push_back(day);
  for (const double border : borders)
    for (int k = -2; k <= 2; ++k) motion.parameters.push_back(border + k * step);
  std::sort(motion.parameters.begin(), motion.parameters.end());
  motion.parameters.erase(std::unique(motion.parameters.begin(), motion.parameters.end()),
                          motion.parameters.end());
  for (const double day : motion.parameters) motion.x.emplace_back(path.at(day).transpose());
  return motion;
}

TEST(KeyPath, GoesThroughItsKeysAndRestsOutside) {
  const KeyPath path(kPathDays, kPathPlaces, Interpolation::monotone);
  for (std::size_t i = 0; i < kPathDays.size(); ++i)
    EXPECT_EQ(path.at(kPathDays[i]), kPathPlaces[i]);
  EXPECT_EQ(path.at(-5), kPathPlaces.front());
  EXPECT_EQ(path.at(50), kPathPlaces.back());
}

TEST(KeyPath, HasOneVelocityOnBothSidesOfEveryKey) {
  const double step = 1.0 / 8192;
  const KeyPath path(kPathDays, kPathPlaces, Interpolation::monotone);
  const KeyPath straight(kPathDays, kPathPlaces, Interpolation::linear);
  EXPECT_LT(
      relative_velocity_jump(sampled_path(path, 0, 10, kPathDays, step), kPathDays, step).value(),
      1e-6);
  EXPECT_GT(relative_velocity_jump(sampled_path(straight, 0, 10, kPathDays, step), kPathDays, step)
                .value(),
            0.1);
}

/// There and back on a line: the tangent turns over where the path comes to rest.
TEST(KeyPath, ComesToRestWhereItGoesBackTheWayThatItCame) {
  const double step = 1.0 / 8192;
  const std::vector<double> days{0, 2, 3};
  const KeyPath path(days, {{0, 0, 0}, {0, 0, 1}, {0, 0, 0.2}}, Interpolation::monotone);
  EXPECT_LT(relative_velocity_jump(sampled_path(path, -1, 4, days, step), days, step).value(),
            1e-5);
  double before = -1;
  for (double day = 0; day <= 2; day += 0.01) {
    EXPECT_GE(path.at(day).z(), before);
    before = path.at(day).z();
  }
}

TEST(KeyPath, StaysBetweenEqualKeys) {
  const KeyPath path({0, 1, 2, 3}, {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 1, 0}},
                     Interpolation::monotone);
  for (double day = 1; day <= 2; day += 0.1) EXPECT_EQ(path.at(day), Eigen::Vector3d(1, 0, 0));
}

/// Two keys: the arc is the chord, the pace 3 u^2 - 2 u^3.
TEST(KeyPath, EasesAlongTheChordOfTwoKeys) {
  const KeyPath path({0, 4}, {{0, 0, 0}, {0, 3, 4}}, Interpolation::monotone);
  const double u = 0.25, done = u * u * (3 - 2 * u);
  EXPECT_LT((path.at(1) - done * Eigen::Vector3d(0, 3, 4)).norm(), 1e-14);
}

TEST(KeyPath, MirroredKeysGiveTheMirroredPathBitForBit) {
  std::vector<Eigen::Vector3d> places = kPathPlaces;
  for (Eigen::Vector3d& place : places) place.x() = -place.x();
  const KeyPath path(kPathDays, kPathPlaces, Interpolation::monotone);
  const KeyPath mirrored(kPathDays, places, Interpolation::monotone);
  for (double day = 0; day < 10; day += 0.137) {
    Eigen::Vector3d expected = path.at(day);
    expected.x() = -expected.x();
    EXPECT_EQ(mirrored.at(day), expected);
  }
}

}  // namespace
}  // namespace geoprior::embryo
