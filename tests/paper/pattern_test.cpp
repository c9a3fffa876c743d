#include "models/paper/pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/error.h"

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

}  // namespace
}  // namespace geoprior::paper
