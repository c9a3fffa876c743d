// Metrics of a tear's path, on paths with known answers.

#include "metrics/tracks/tear_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"

namespace geoprior {
namespace {

using Eigen::Vector2d;

const Vector2d kA(-0.1, 0), kB(0.1, 0);

TEST(TearPath, BisectorKeepsToTheHyperbola) {
  // |CA| - |CB| is conserved exactly; what drifts is the integration, at third order.
  const TearPath path = bisector_path({0.02, 0.05}, kA, kB, 0.2, 1e-3);
  EXPECT_NEAR(path_length(path), 0.2, 1e-12);
  EXPECT_LT(focal_drift(path, kA, kB), 1e-6);
  const double coarse = focal_drift(bisector_path({0.02, 0.05}, kA, kB, 0.2, 0.01), kA, kB);
  const double fine = focal_drift(bisector_path({0.02, 0.05}, kA, kB, 0.2, 0.005), kA, kB);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 3, 0.3);
}

TEST(TearPath, SymmetricPullsTearStraightOn) {
  const TearPath path = bisector_path({0, 0.05}, kA, kB, 0.1, 1e-3);
  EXPECT_NEAR(chord_angle_deg(path, {0, 1}), 0, 1e-9);
  EXPECT_NEAR(path_bow(path), 0, 1e-12);
  EXPECT_THROW(static_cast<void>(bisector_path({0.02, 0}, kA, kB, 0.1, 1e-3)), Error);
}

TEST(TearPath, DriftOfAStraightLineIsWhatItIs) {
  // Straight up from (0.05, 0): |CA| - |CB| falls from 0.1.
  const TearPath path{{0.05, 0}, {0.05, 0.1}};
  const double end = std::hypot(0.15, 0.1) - std::hypot(0.05, 0.1);
  EXPECT_NEAR(focal_drift(path, kA, kB), (0.1 - end) / 0.2, 1e-12);
  EXPECT_THROW(static_cast<void>(focal_drift(path, kA, kA)), Error);
}

TEST(TearPath, AngleBowAndDistanceOfSimplePaths) {
  const TearPath arc{{0, 0}, {1, 1}, {2, 0}};
  EXPECT_NEAR(path_bow(arc), 0.5, 1e-12);
  EXPECT_NEAR(chord_angle_deg(arc, {1, 1}), 45, 1e-9);
  const TearPath shifted{{0, 0.25}, {1, 1.25}, {2, 0.25}};
  EXPECT_NEAR(path_distance(arc, shifted), 0.25, 1e-12);
  EXPECT_NEAR(path_distance(arc, {{0, 0}, {2, 0}}), 1, 1e-12);
  EXPECT_THROW(static_cast<void>(path_distance(arc, {})), Error);
}

TEST(TearPath, ParallelLinesAreTheirDistanceApart) {
  // 10 mm beside a line of 0.2 m, in steps of another length and twice as far: a twentieth.
  const TearPath line{{0, 0}, {0.2, 0}};
  TearPath beside;
  for (int i = 0; i <= 100; ++i) beside.emplace_back(i * 4e-3, 0.01);
  const PathComparison c = compare_paths(beside, line);
  EXPECT_NEAR(c.distance, 0.01, 1e-12);
  EXPECT_NEAR(c.drift, 0.05, 1e-12);
  EXPECT_NEAR(c.deviation, 0, 1e-9);
  const PathComparison same = compare_paths(line, line);
  EXPECT_EQ(same.distance, 0);
  EXPECT_EQ(same.drift, 0);
  EXPECT_EQ(same.deviation, 0);
}

TEST(TearPath, LinesFromOnePointDriftBySinOfTheirAngle) {
  const double angle = std::numbers::pi / 18;
  const TearPath line{{0, 0}, {0.1, 0}};
  const TearPath turned{{0, 0}, {0.3 * std::cos(angle), 0.3 * std::sin(angle)}};
  const PathComparison c = compare_paths(turned, line);
  EXPECT_NEAR(c.drift, std::sin(angle), 1e-12);
  EXPECT_NEAR(c.deviation, 10, 1e-9);
  // What a path drifts does not depend on its unit, nor on where the plane's origin is.
  TearPath large, moved;
  for (const Vector2d& p : turned) large.push_back(7 * p);
  for (const Vector2d& p : line) moved.push_back(7 * p);
  EXPECT_NEAR(compare_paths(large, moved).drift, c.drift, 1e-12);
  EXPECT_THROW(static_cast<void>(compare_paths({{0, 0}}, line)), Error);
}

TEST(TearPath, OnsetForceIsTheClosedForm) {
  // K e / (2 cos(theta / 2)): a right angle at C; legs of a trouser side by side.
  EXPECT_NEAR(onset_force({0, 0.1}, kA, kB, 1e4, 1e-4), 1 / (2 * std::cos(std::numbers::pi / 4)),
              1e-12);
  EXPECT_NEAR(onset_force({0, 0}, {0, -1}, {0, -1}, 1e4, 1e-4), 0.5, 1e-12);
}

TEST(TearPath, TheLongestIsTheFirstOfThoseAsLong) {
  const std::vector<TearPath> paths{{{0, 0}}, {{0, 0}, {0, 2}}, {{0, 0}, {1, 0}, {1, 1}}};
  EXPECT_EQ(longest_path(paths), &paths[1]);
  EXPECT_EQ(longest_path({TearPath{{0.1, 0.2}}}), nullptr) << "a point has no length";
}

TEST(TearPath, TheFirstPartHasTheLengthAskedFor) {
  const TearPath path{{0, 0}, {1, 0}, {1, 0}, {1, 1}};
  EXPECT_EQ(first_part(path, 1.25), (TearPath{{0, 0}, {1, 0}, {1, 0.25}}));
  EXPECT_DOUBLE_EQ(path_length(first_part(path, 9)), 2);
  EXPECT_EQ(first_part(path, 0), (TearPath{{0, 0}}));
}

TEST(TearPath, FractureEnergyIsToughnessOverTheTornSection) {
  // A sheet whose toughness grows along x, and is tripled across the grain: the middle of each
  // step decides, so a linear field is exact.
  const auto toughness = [](const Vector2d& at, const Vector2d& along) {
    return (1 + at.x()) * (std::abs(along.y()) > 0.5 ? 3 : 1);
  };
  const std::vector<TearPath> paths{{{0, 0}, {0.4, 0}, {0.4, 0}, {0.4, 0.2}}, {{1, 1}}};
  EXPECT_NEAR(fracture_energy(paths, toughness, 1e-4), 1e-4 * (0.4 * 1.2 + 0.2 * 3 * 1.4), 1e-18);
}

}  // namespace
}  // namespace geoprior
