#include "metrics/contact/planar_overlap.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

double common_area_of(const std::vector<TrianglePair>& pairs) {
  return std::accumulate(pairs.begin(), pairs.end(), 0.0,
                         [](double sum, const TrianglePair& p) { return sum + p.area; });
}

/// A strip of `cells` rectangles along a circle of this radius, through `turn` (rad): it lies on
/// itself where it has turned by more than a full turn.
sheets::Sheet curled_strip(double inner, double outer, double turn, int cells) {
  sheets::Sheet s = sheets::rectangle(1, 1, cells, 1);
  for (Eigen::Index v = 0; v < s.pattern.rows(); ++v) {
    const double angle = turn * (s.pattern(v, 0) + 0.5);
    const double radius = s.pattern(v, 1) > 0 ? inner : outer;
    s.pattern.row(v) << radius * std::cos(angle), radius * std::sin(angle);
  }
  return s;
}

TEST(WindingNumber, CountsTurnsAndTheirDirection) {
  const PlanarLoop square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  EXPECT_EQ(winding_number(square, {0.5, 0.5}), 1);
  EXPECT_EQ(winding_number({square.rbegin(), square.rend()}, {0.5, 0.5}), -1);
  EXPECT_EQ(winding_number(square, {1.5, 0.5}), 0);
  PlanarLoop twice = square;
  twice.insert(twice.end(), square.begin(), square.end());
  EXPECT_EQ(winding_number(twice, {0.5, 0.5}), 2);
  // A bow tie winds about its two halves the opposite ways.
  const PlanarLoop bow{{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  EXPECT_EQ(winding_number(bow, {0.1, 0.5}) + winding_number(bow, {0.9, 0.5}), 0);
  EXPECT_EQ(std::abs(winding_number(bow, {0.1, 0.5})), 1);
}

TEST(WindingNumber, EveryPointOfATilingIsInOneTile) {
  // Points on common sides and corners too: the rule is that of a shift.
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(1, 0.5), Eigen::Vector2d(1, 1),
                                   Eigen::Vector2d(0.5, 1), Eigen::Vector2d(0.5, 0.5)}) {
    int tiles = 0;
    for (int x = -1; x < 3; ++x) {
      for (int y = -1; y < 3; ++y) {
        const Eigen::Vector2d o(x, y);
        tiles += winding_number(
            {o, o + Eigen::Vector2d(1, 0), o + Eigen::Vector2d(1, 1), o + Eigen::Vector2d(0, 1)},
            p);
      }
    }
    EXPECT_EQ(tiles, 1);
  }
}

TEST(OutlineCrossings, OfARectangleWhoseOutlineCrossesItself) {
  const PlanarLoop rectangle{{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  EXPECT_EQ(outline_crossings(std::array{rectangle}), 0);
  const PlanarLoop bow{{0, 0}, {2, 0}, {0, 1}, {2, 1}};
  EXPECT_EQ(outline_crossings(std::array{bow}), 1);
  // Repeated points, also at the end, change nothing.
  const PlanarLoop repeated{{0, 0}, {0, 0}, {2, 0}, {2, 1}, {2, 1}, {0, 1}, {0, 0}};
  EXPECT_EQ(outline_crossings(std::array{repeated}), 0);
}

TEST(OutlineCrossings, SeesWhatRunsBackAndOtherLoops) {
  // A spike of no width: its sides run over each other.
  const PlanarLoop spike{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {1, 1}, {0, 1}};
  EXPECT_GT(outline_crossings(std::array{spike}), 0);
  const PlanarLoop outer{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const PlanarLoop hole{{1, 1}, {1, 2}, {2, 2}, {2, 1}};
  EXPECT_EQ(outline_crossings(std::array{outer, hole}), 0);
  PlanarLoop out = hole;
  for (Eigen::Vector2d& p : out) p.x() += 2.5;  // sticks out of one side
  EXPECT_EQ(outline_crossings(std::array{outer, out}), 2);
}

TEST(OverlappingTriangles, NoneInATriangulationHoweverItLies) {
  for (const double jitter : {0.0, 0.3}) {
    const sheets::Sheet s = sheets::turned_pattern(sheets::rectangle(3, 2, 12, 9, jitter), 0.4);
    EXPECT_TRUE(overlapping_triangles(s.pattern, s.triangles).empty());
  }
  const sheets::Sheet almost = curled_strip(1, 2, 2 * std::numbers::pi - 1e-9, 60);
  EXPECT_TRUE(overlapping_triangles(almost.pattern, almost.triangles).empty());
}

TEST(OverlappingTriangles, SidesOfAClosedSlitTouchOnly) {
  // Two squares side by side with points of their own on the common side.
  Eigen::MatrixX2d points(8, 2);
  points << 0, 0, 1, 0, 1, 1, 0, 1, 1, 0, 2, 0, 2, 1, 1, 1;
  Eigen::MatrixX3i triangles(4, 3);
  triangles << 0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7;
  EXPECT_TRUE(overlapping_triangles(points, triangles).empty());
  points(5, 0) = 2.5;  // no change at the common side
  EXPECT_TRUE(overlapping_triangles(points, triangles).empty());
  points(7, 0) = std::nextafter(1.0, 0.0);  // over it by one unit of round-off
  EXPECT_FALSE(overlapping_triangles(points, triangles).empty());
}

TEST(OverlappingTriangles, OfAStripThatCurlsOntoItself) {
  // No triangle is turned over, yet two of sixty cells lie on the first two. Each cell is a
  // trapezium: half the difference of the squared radii times sin of its angle.
  const double cell = 2 * std::numbers::pi / 60;
  const sheets::Sheet s = curled_strip(1, 2, 62 * cell, 62);
  const std::vector<TrianglePair> pairs = overlapping_triangles(s.pattern, s.triangles);
  EXPECT_NEAR(common_area_of(pairs), 2 * 1.5 * std::sin(cell), 1e-12);
  for (const TrianglePair& p : pairs) {
    EXPECT_LT(p.first, 4);
    EXPECT_GE(p.second, 2 * 60);
  }
}

TEST(OverlappingTriangles, OfASheetFoldedOntoItself) {
  // Folded flat along its middle: half of it lies on the other half.
  sheets::Sheet s = sheets::rectangle(1, 0.6, 8, 5, 0);
  s.pattern.col(0) = s.pattern.col(0).cwiseAbs();
  const std::vector<TrianglePair> pairs = overlapping_triangles(s.pattern, s.triangles);
  EXPECT_NEAR(common_area_of(pairs), 0.3, 1e-12);
}

TEST(OverlappingTriangles, OneInsideAnotherAndThreeOfALayer) {
  Eigen::MatrixX2d points(6, 2);
  points << 0, 0, 10, 0, 0, 10, 1, 1, 2, 1, 1, 2;
  Eigen::MatrixX3i triangles(3, 3);
  triangles << 0, 1, 2, 3, 4, 5, 3, 5, 4;  // the last is turned over
  const std::vector<TrianglePair> pairs = overlapping_triangles(points, triangles);
  ASSERT_EQ(pairs.size(), 3u);  // k (k - 1) / 2 of three layers
  EXPECT_NEAR(common_area_of(pairs), 3 * 0.5, 1e-15);
  EXPECT_EQ(pairs[2].first, 1);
  EXPECT_EQ(pairs[2].second, 2);
  const std::array group{0, 1, 1};
  EXPECT_EQ(overlapping_triangles(points, triangles, group).size(), 2u);
}

TEST(OverlappingTriangles, RefusesWhatItCannotJudge) {
  sheets::Sheet s = sheets::rectangle(1, 1, 2, 2);
  const std::array group{0, 1};
  EXPECT_THROW(overlapping_triangles(s.pattern, s.triangles, group), Error);
  s.pattern(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(overlapping_triangles(s.pattern, s.triangles), Error);
}

}  // namespace
}  // namespace geoprior
