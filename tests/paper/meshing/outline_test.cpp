#include "models/paper/meshing/outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "models/paper/sheet/valid.h"
#include "tests/paper/contact/plane_shapes.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;
using plane_shapes::ell_pattern;
using plane_shapes::pierced_square;

bool has_corner(const std::vector<Vector2d>& loop, const Vector2d& p) {
  return std::any_of(loop.begin(), loop.end(),
                     [&](const Vector2d& q) { return (p - q).norm() < 1e-15; });
}

double longest_side(const std::vector<Vector2d>& loop) {
  double longest = 0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    longest = std::max(longest, (loop[(i + 1) % loop.size()] - loop[i]).norm());
  return longest;
}

// A program's circle of any number of corners becomes the same for a mesh.
TEST(Outline, DiscsOfManyCornersAreOne) {
  const double edge = 0.025;
  for (const int corners : {96, 400, 1000}) {
    const Pattern disc = disc_pattern(0.1, corners), coarse = resampled(disc, edge, {});
    EXPECT_EQ(coarse.border.size(), 25U) << corners;
    EXPECT_NEAR(signed_area(coarse), signed_area(disc), 1e-12) << corners;
    for (const Vector2d& p : coarse.border) EXPECT_NEAR(p.norm(), 0.1, 6e-4) << corners;
    EXPECT_LT(longest_side(coarse.border), 1.02 * edge);
  }
}

TEST(Outline, WhatIsCoarserThanTheMeshStays) {
  const Pattern disc = disc_pattern(0.1, 24);
  EXPECT_EQ(resampled(disc, 0.025, {}).border, disc.border);
  const Pattern sheet = rectangle_pattern(0.2, 0.1);
  EXPECT_EQ(resampled(sheet, 0.025, {}).border, sheet.border);
  EXPECT_EQ(resampled(sheet, 1, {{0.03, 0.05}}).border, sheet.border);
  EXPECT_EQ(resampled(ell_pattern(), 0.5, {}).border, ell_pattern().border);
  const Pattern pierced = resampled(pierced_square(), 10, {});
  EXPECT_EQ(pierced.border, pierced_square().border);
  EXPECT_EQ(pierced.holes, pierced_square().holes);
}

// A rectangle with one round corner of 30 arcs.
TEST(Outline, CornersAndLongSidesStay) {
  Pattern sheet = rectangle_pattern(0.2, 0.1);
  const Vector2d centre(0.08, 0.03);
  sheet.border.erase(sheet.border.begin() + 2);
  for (int k = 30; k >= 0; --k) {
    const double angle = std::numbers::pi / 2 * (30 - k) / 30;
    sheet.border.insert(sheet.border.begin() + 2 + (30 - k),
                        centre + 0.02 * Vector2d(std::cos(angle), std::sin(angle)));
  }
  const Pattern coarse = resampled(sheet, 0.025, {});
  EXPECT_NEAR(signed_area(coarse), signed_area(sheet), 1e-12);
  // Three corners, both ends of the arc, and two between: it turns by 90 degrees.
  EXPECT_EQ(coarse.border.size(), 7U);
  for (const Vector2d& p : {Vector2d(-0.1, -0.05), Vector2d(0.1, -0.05), Vector2d(-0.1, 0.05),
                            Vector2d(0.1, 0.03), Vector2d(0.08, 0.05)})
    EXPECT_TRUE(has_corner(coarse.border, p)) << p.transpose();
}

TEST(Outline, KeptPointsAreCornersOfIt) {
  const Pattern disc = disc_pattern(0.1, 400);
  const Vector2d on_side = 0.3 * disc.border[57] + 0.7 * disc.border[58];
  const Pattern coarse = resampled(disc, 0.025, {disc.border[10], on_side, {0, 0}});
  EXPECT_TRUE(has_corner(coarse.border, disc.border[10]));
  EXPECT_TRUE(has_corner(coarse.border, on_side));
  EXPECT_NEAR(signed_area(coarse), signed_area(disc), 1e-9);
}

// A ring 0.2 mm wide of 300 corners: a dozen corners on each loop would cross by a millimetre.
TEST(Outline, NeverTouchesItself) {
  Pattern ring = disc_pattern(0.05, 300);
  std::vector<Vector2d> hole = disc_pattern(0.0498, 300).border;
  for (Vector2d& p : hole) p = Eigen::Rotation2Dd(0.1) * p;
  ring.holes = {{hole.rbegin(), hole.rend()}};
  const Pattern coarse = resampled(ring, 0.04, {});
  EXPECT_NO_THROW(require_simple(coarse, "ring"));
  EXPECT_GT(coarse.border.size(), 12U) << "as few as where nothing is beside it";
  EXPECT_LT(coarse.border.size(), 300U);
  EXPECT_NEAR(signed_area(coarse), signed_area(ring), 1e-9);
}

// The holes of a drawing run the other way round; a cut ends on one.
TEST(Outline, RoundHolesAndEndsOfCuts) {
  Pattern sheet = rectangle_pattern(0.2, 0.2);
  const std::vector<Vector2d> hole = disc_pattern(0.04, 200).border;
  sheet.holes = {{hole.rbegin(), hole.rend()}};
  const Vector2d end = 0.4 * hole[20] + 0.6 * hole[21];
  sheet.cuts = {{end, Vector2d(0.08, 0.06)}};
  const Pattern coarse = resampled(sheet, 0.02, {end});
  EXPECT_NO_THROW(require_simple(coarse, "sheet"));
  EXPECT_LT(coarse.holes[0].size(), 20U);
  EXPECT_TRUE(has_corner(coarse.holes[0], end));
  EXPECT_EQ(coarse.cuts, sheet.cuts);
  EXPECT_NEAR(signed_area(coarse), signed_area(sheet), 1e-9);
}

// Its straight sides are longer than an edge until the hand on one of them divides it.
TEST(Outline, AHandOnALongSideDoesNotRoundItsEnds) {
  Pattern sheet = rectangle_pattern(0.2, 0.03);
  for (const double side : {1.0, -1.0}) {
    std::vector<Vector2d> cap;
    for (int k = 1; k < 40; ++k) {
      const double angle = side * (std::numbers::pi * k / 40 - std::numbers::pi / 2);
      cap.emplace_back(side * 0.1 + 0.015 * std::cos(angle) * side, 0.015 * std::sin(angle));
    }
    const auto at = side > 0 ? sheet.border.begin() + 2 : sheet.border.end();
    sheet.border.insert(at, cap.begin(), cap.end());
  }
  ASSERT_NO_THROW(require_simple(sheet, "stadium"));
  const Pattern coarse = resampled(sheet, 0.15, {{0, -0.015}});
  for (const double x : {-0.1, 0.1}) {
    for (const double y : {-0.015, 0.015})
      EXPECT_TRUE(has_corner(coarse.border, {x, y})) << x << " " << y;
  }
}

TEST(Outline, HandlesStayInTheSheet) {
  Sheet sheet;
  sheet.pattern = disc_pattern(0.1, 1000);
  Handle hand;
  hand.name = "hand";
  hand.force = Eigen::Vector3d(0, 0, 0.1);
  hand.points = {sheet.pattern.border[123], {0.0998 * std::cos(2.0), 0.0998 * std::sin(2.0)}};
  sheet.handles = {hand};
  const Sheet coarse = with_outline(sheet, 0.05);
  EXPECT_LT(coarse.pattern.border.size(), 20U);
  for (const Vector2d& p : hand.points) EXPECT_TRUE(contains(coarse.pattern, p, 1e-9));
}

// A hand that only just lies on the sheet would reach over the chord that takes the place of an
// arc.
TEST(Outline, AHandThatTouchesTheBorderStaysOnTheSheet) {
  Sheet sheet;
  sheet.pattern = disc_pattern(0.1, 1000);
  Handle hand;
  hand.name = "hand";
  hand.points = {{0.09, 0}};
  hand.disc_radius = 0.009999;
  hand.force = Eigen::Vector3d(0, 0, 0.1);
  sheet.handles = {hand};
  ASSERT_NO_THROW(require_valid(sheet, "sheet"));
  const Sheet coarse = with_outline(sheet, 0.0042);
  EXPECT_NO_THROW(require_valid(coarse, "sheet"));
  EXPECT_LT(coarse.pattern.border.size(), 1000U);
}

}  // namespace
}  // namespace geoprior::paper
