#include "models/paper/sheet/pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/error.h"
#include "tests/paper/contact/plane_shapes.h"

namespace geoprior::paper {
namespace {

/// What `require_simple` says, or "" when the pattern is accepted.
std::string complaint(const Pattern& pattern) {
  try {
    require_simple(pattern, "sheet.toml");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(Pattern, AreaOfASquareIsPositiveCounterClockwise) {
  EXPECT_DOUBLE_EQ(signed_area({{{0, 0}, {2, 0}, {2, 2}, {0, 2}}}), 4);
  EXPECT_DOUBLE_EQ(signed_area({{{0, 0}, {0, 2}, {2, 2}, {2, 0}}}), -4);
}

// Regular polygon inscribed in a circle: n/2 r^2 sin(2 pi / n).
TEST(Pattern, DiscIsTheInscribedRegularPolygon) {
  const Pattern disc = disc_pattern(0.3, 48);
  EXPECT_EQ(complaint(disc), "");
  EXPECT_NEAR(signed_area(disc), 24 * 0.09 * std::sin(2 * std::numbers::pi / 48), 1e-15);
  EXPECT_NEAR(diameter(disc), 0.6, 1e-15);
  EXPECT_NEAR(width(disc), 0.6, 1e-15);
}

TEST(Pattern, RectangleHasItsSidesAndDiagonal) {
  const Pattern sheet = rectangle_pattern(0.3, 0.4);
  EXPECT_EQ(complaint(sheet), "");
  EXPECT_DOUBLE_EQ(signed_area(sheet), 0.12);
  EXPECT_DOUBLE_EQ(diameter(sheet), 0.5);
  EXPECT_DOUBLE_EQ(width(sheet), 0.4);
}

TEST(Pattern, RefusesShapesWithoutArea) {
  EXPECT_THROW(rectangle_pattern(0, 1), Error);
  EXPECT_THROW(rectangle_pattern(1, std::numeric_limits<double>::infinity()), Error);
  EXPECT_THROW(disc_pattern(-1, 8), Error);
  EXPECT_THROW(disc_pattern(1, 2), Error);
}

TEST(Pattern, NamesTheCornerThatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(complaint({{{0, 0}, {1, 0}, {nan, 1}}}).find("sheet.toml corner 2"), std::string::npos);
}

TEST(Pattern, IsRefusedWhenItIsTooThinToBeMeshed) {
  EXPECT_EQ(complaint({{{0, 0}, {1000, 0}, {1000, 0.01}, {0, 0.01}}}), "");
  EXPECT_NE(complaint({{{0, 0}, {1e6, 0}, {1e6, 0.01}, {0, 0.01}}}).find("too thin"),
            std::string::npos);
}

TEST(Pattern, NeedsThreeCornersThatAreNotCollinear) {
  EXPECT_NE(complaint({{{0, 0}, {1, 0}}}).find("2 corners"), std::string::npos);
  EXPECT_NE(complaint({{{0, 0}, {1, 1}, {3, 3}}}).find("collinear"), std::string::npos);
}

TEST(Pattern, NamesACornerThatIsThereTwice) {
  const std::string text = complaint({{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}});
  EXPECT_NE(text.find("corner 4"), std::string::npos);
  EXPECT_NE(text.find("corner 0"), std::string::npos);
}

TEST(Pattern, NamesTheTipOfASpike) {
  const std::string text = complaint({{{0, 0}, {2, 0}, {1, 0}, {1, 1}}});
  EXPECT_NE(text.find("corner 1"), std::string::npos) << text;
}

TEST(Pattern, NamesBothEdgesThatCross) {
  const std::string text = complaint({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}});
  EXPECT_NE(text.find("edge 2"), std::string::npos) << text;
  EXPECT_NE(text.find("edge 0"), std::string::npos) << text;
}

TEST(Pattern, RefusesACornerThatTouchesAnotherEdge) {
  const std::string text = complaint({{{0, 0}, {4, 0}, {4, 2}, {2, 0}, {0, 2}}});
  EXPECT_NE(text.find("touches edge 0"), std::string::npos) << text;
}

TEST(Pattern, RefusesClockwiseAndAcceptsStraightCorners) {
  EXPECT_NE(complaint({{{0, 0}, {0, 1}, {1, 1}, {1, 0}}}).find("clockwise"), std::string::npos);
  EXPECT_EQ(complaint({{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {0, 1}}}), "");
}

// The notch of an L: (1.5, 1.5) lies in its bounding box, and outside of it.
TEST(Pattern, ContainsWithTolerance) {
  const Pattern ell{{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}};
  EXPECT_TRUE(contains(ell, {0.5, 1.5}));
  EXPECT_FALSE(contains(ell, {1.5, 1.5}));
  EXPECT_FALSE(contains(ell, {1.01, 1.5}, 0.005));
  EXPECT_TRUE(contains(ell, {1.01, 1.5}, 0.02));
  EXPECT_TRUE(contains(ell, {2, 0.5}));
  EXPECT_TRUE(contains(ell, {1, 1}));
}

TEST(Pattern, NearestBorderPointIsOnTheRightEdge) {
  const BorderPoint b = nearest_on_border(rectangle_pattern(2, 1), {0.9, 0.25});
  EXPECT_EQ(b.edge, 1);
  EXPECT_DOUBLE_EQ(b.t, 0.75);
  EXPECT_NEAR(b.distance, 0.1, 1e-15);
  EXPECT_EQ(b.point, Eigen::Vector2d(1, 0.25));
}

// 16, less 1 and a triangle of base 1 and height 1.
TEST(PatternWithHoles, AreaContentAndBorder) {
  const Pattern p = plane_shapes::pierced_square();
  EXPECT_EQ(complaint(p), "");
  EXPECT_DOUBLE_EQ(signed_area(p), 14.5);
  EXPECT_DOUBLE_EQ(width(p), 4);
  EXPECT_EQ(corners(p).size(), 11U);
  EXPECT_TRUE(contains(p, {0, 0}));
  EXPECT_FALSE(contains(p, {1, 1}));
  EXPECT_FALSE(contains(p, {-1, -1}));
  EXPECT_FALSE(contains(p, {2.1, 0}));
  EXPECT_FALSE(contains(p, {0.6, 1}, 0.05));
  EXPECT_TRUE(contains(p, {0.6, 1}, 0.15));
  const BorderPoint b = nearest_on_border(p, {1.4, 1.1});
  EXPECT_EQ(b.edge, 6) << "4 edges of the border; that from (1.5, 1.5) to (1.5, 0.5)";
  EXPECT_NEAR(b.distance, 0.1, 1e-15);
  EXPECT_NEAR(b.t, 0.4, 1e-15);
  EXPECT_NEAR((b.point - Eigen::Vector2d(1.5, 1.1)).norm(), 0, 1e-15);
}

TEST(PatternWithHoles, NumbersCornersAndEdgesThroughAllLoops) {
  const Pattern p = plane_shapes::pierced_square();
  const std::vector<Eigen::Vector2d> all = corners(p);
  int edge = 0;
  each_edge(p, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    EXPECT_EQ(a, all[edge]);
    EXPECT_EQ(b, all[next_edge(p, edge)]);
    // The material is on the left.
    const Eigen::Vector2d along = b - a;
    EXPECT_TRUE(contains(p, (a + b) / 2 + 0.01 * Eigen::Vector2d(-along.y(), along.x())));
    EXPECT_FALSE(contains(p, (a + b) / 2 - 0.01 * Eigen::Vector2d(-along.y(), along.x())));
    ++edge;
  });
  EXPECT_EQ(edge, 11);
  EXPECT_EQ(next_edge(p, 3), 0);
  EXPECT_EQ(next_edge(p, 7), 4);
  EXPECT_EQ(next_edge(p, 10), 8);
  EXPECT_THROW((void)next_edge(p, 11), Error);
}

TEST(PatternWithHoles, AreTurnedTheRightWayRound) {
  Pattern p = plane_shapes::pierced_square();
  std::reverse(p.border.begin(), p.border.end());
  std::reverse(p.holes[1].begin(), p.holes[1].end());
  EXPECT_NE(complaint(p).find("runs clockwise"), std::string::npos);
  std::reverse(p.border.begin(), p.border.end());
  EXPECT_NE(complaint(p).find("hole 1: hole of the pattern runs counter-clockwise"),
            std::string::npos);
  std::reverse(p.border.begin(), p.border.end());
  EXPECT_NO_THROW(require_simple_loops(p, "either way"));
  EXPECT_EQ(complaint(oriented(p)), "");
  EXPECT_DOUBLE_EQ(signed_area(oriented(p)), 14.5);
}

TEST(PatternWithHoles, NamesTheHoleThatIsNone) {
  const auto with = [](std::vector<Eigen::Vector2d> hole) {
    Pattern p = plane_shapes::pierced_square();
    p.holes[1] = std::move(hole);
    return complaint(p);
  };
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(with({{3, 0}, {3, 1}, {4, 1}}), "sheet.toml hole 1: hole lies outside of the border");
  has(with({{0.8, 0.8}, {0.8, 1.2}, {1.2, 1.2}}), "hole 1: hole lies in hole 0");
  has(with({{1, 1}, {1, -1}, {0, -1}, {0, 1}}), "sheet.toml hole 1 edge 3");
  has(with({{1, 1}, {1, -1}, {0, -1}, {0, 1}}), "of hole 0");
  has(with({{1, 0}, {3, 0.2}, {3, 0}}), "edge 1 of the border");
  has(with({{2, 0}, {1.5, -1}, {1.5, 0}}), "edge 1 of the border");  // touches it with a corner
  has(with({{2 - 1e-9, 0}, {1.5, -1}, {1.5, 0}}), "edge 1 of the border");
  has(with({{0, 0}, {0, 1}}), "hole 1: pattern has 2 corners");
  has(with({{0, 0}, {0, 0.2}, {0, 0.4}}), "hole 1: corners of the pattern are collinear");
  has(with({{-1, 0}, {0, 1e-8}, {0, 0}}), "hole 1: pattern is too thin");
  has(with({{-1, -1}, {0, 0}, {0, -1}, {-1, 0}}), "hole 1 edge 2: edge crosses or touches edge 0");
  // A hole about another one contains none of its corners.
  has(with({{0.2, 0.2}, {0.2, 1.8}, {1.8, 1.8}, {1.8, 0.2}}), "hole 0: hole lies in hole 1");
}

TEST(PatternWithHoles, CountsTheCornersOfAllLoops) {
  Pattern p = disc_pattern(1, kMostCorners - 2);
  p.holes = {{{0, 0}, {0, 0.1}, {0.1, 0}}};
  EXPECT_NE(complaint(p).find("10001"), std::string::npos) << complaint(p);
}

TEST(PatternWithHoles, ASegmentLeavesItOverAHole) {
  const Pattern p = plane_shapes::pierced_square();
  EXPECT_FALSE(leaves_pattern(p, {-1.8, 0}, {1.8, 0}, 1e-9));
  EXPECT_FALSE(leaves_pattern(p, {-2, -2}, {2, -2}, 1e-9)) << "along the border";
  EXPECT_FALSE(leaves_pattern(p, {0.5, -1}, {0.5, 1.8}, 1e-9)) << "along a side of the hole";
  const auto out = leaves_pattern(p, {0, 1}, {1.8, 1}, 1e-9);
  ASSERT_TRUE(out);
  EXPECT_NEAR((*out - Eigen::Vector2d(1, 1)).norm(), 0, 1e-12);
  EXPECT_TRUE(leaves_pattern(p, {0.5, 1}, {1, 0.5}, 1e-9)) << "both ends on the hole";
  EXPECT_TRUE(leaves_pattern(p, {0, 0}, {3, 0}, 1e-9));
}

}  // namespace
}  // namespace geoprior::paper
