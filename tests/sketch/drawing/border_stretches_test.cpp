#include "solvers/sketch/hidden/border_stretches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace geoprior::sketch {
namespace {

Stretch stretch_of(const std::vector<Eigen::Vector2d>& points) {
  Stretch stretch;
  for (const Eigen::Vector2d& p : points) stretch.push_back({p, {}});
  return stretch;
}

PictureCurve line(int points) {
  PictureCurve curve;
  for (int i = 0; i < points; ++i) curve.points.emplace_back(i, 0);
  return curve;
}

TEST(BorderStretches, LieAlongALineInItsSense) {
  const auto placed =
      placed_along(line(11), {stretch_of({{9, 0}, {8, 0}, {7, 0}}), stretch_of({{1, 0}, {2, 0}})});
  ASSERT_EQ(placed.size(), 2U);
  EXPECT_FALSE(placed[0].turned);
  EXPECT_EQ(placed[0].begin, 1);
  EXPECT_TRUE(placed[1].turned);
  EXPECT_EQ(placed[1].begin, 7);
  EXPECT_EQ(placed[1].end, 9);
  EXPECT_EQ(placed[1].stretch.front().p.x(), 7);
}

TEST(BorderStretches, GoRoundAClosedModelPastItsFirstPoint) {
  PictureCurve circle{{}, true};
  const auto at = [](int i) {
    const double angle = 2 * std::numbers::pi * i / 12;
    return Eigen::Vector2d(std::cos(angle), std::sin(angle));
  };
  for (int i = 0; i < 12; ++i) circle.points.push_back(at(i));
  const auto placed = placed_along(circle, {stretch_of({at(10), at(11), at(12), at(13)})});
  ASSERT_EQ(placed.size(), 1U);
  EXPECT_FALSE(placed[0].turned);
  EXPECT_NEAR(placed[0].end - placed[0].begin, 3, 1e-9);
  EXPECT_NEAR(length_between(circle, placed[0].begin, placed[0].end),
              6 * std::sin(std::numbers::pi / 12), 1e-9);
}

TEST(BorderStretches, AreFilledFromPointToPoint) {
  const PictureCurve model = line(11);
  FollowedModel whole{model, {}, 0};
  whole.fill(2, 6, Eigen::Vector2d(2, 0.4), Eigen::Vector2d(6, 0));
  ASSERT_EQ(whole.points.size(), 3U);
  EXPECT_NEAR(whole.points[1].p.y(), 0.2, 1e-12) << "half of the way";
  EXPECT_NEAR(whole.added, 4 * std::hypot(1, 0.1), 1e-12);
  EXPECT_EQ(whole.points[1].place.stroke, -1) << "drawn nowhere";
}

TEST(BorderStretches, LeaveTheirEndsInTheirDirection) {
  const Stretch stretch = stretch_of({{0, 0}, {1, 0}, {2, 0}, {3, 0}});
  EXPECT_NEAR((direction_out(stretch, true, 10) - Eigen::Vector2d(1, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((direction_out(stretch, false, 10) - Eigen::Vector2d(-1, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(stretch_length(stretch), 3, 1e-12);
}

}  // namespace
}  // namespace geoprior::sketch
