#include "core/geometry/planar.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "core/error.h"

namespace geoprior {
namespace {

using Eigen::Vector2d;

/// Points next to (1/2, 1/2), a few units in the last place away, against the line x = y through
/// far points: the example of Kettner et al. 2008, where rounded determinants are wrong.
TEST(Planar, OrientationIsExactWhereTheDeterminantIsNot) {
  const Vector2d a(12, 12), b(24, 24);
  constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
  int wrong = 0;
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 16; ++j) {
      const Vector2d p(0.5 + i * kUnit, 0.5 + j * kUnit);
      const int side = p.y() > p.x() ? 1 : p.y() < p.x() ? -1 : 0;
      ASSERT_EQ(orientation(a, b, p), side) << i << ", " << j;
      const double rounded = cross(b - p, a - p);
      if ((rounded < 0 ? 1 : rounded > 0 ? -1 : 0) != side) ++wrong;
    }
  }
  EXPECT_GT(wrong, 0) << "the determinant got all signs: the example shows nothing";
}

TEST(Planar, SegmentsMeetInAnEndACrossingOrAnOverlap) {
  EXPECT_TRUE(segments_meet({0, 0}, {2, 2}, {0, 2}, {2, 0}));
  EXPECT_TRUE(segments_meet({0, 0}, {1, 0}, {1, 0}, {1, 1})) << "a common end";
  EXPECT_TRUE(segments_meet({0, 0}, {2, 0}, {1, 0}, {1, 1})) << "an end inside the other";
  EXPECT_TRUE(segments_meet({0, 0}, {2, 0}, {1, 0}, {3, 0})) << "along one line";
  EXPECT_FALSE(segments_meet({0, 0}, {1, 0}, {2, 0}, {3, 0})) << "apart on one line";
  EXPECT_FALSE(segments_meet({0, 0}, {1, 0}, {0, 1}, {1, 1})) << "parallel";
  EXPECT_FALSE(segments_meet({0, 0}, {1, 1}, {1.1, 0}, {2, 5}));
}

TEST(Planar, CrossIsTwiceTheSignedArea) {
  EXPECT_EQ(cross({3, 0}, {1, 2}), 6);
  EXPECT_EQ(cross({1, 2}, {3, 0}), -6);
}

TEST(Planar, SignedAngleTurnsCounterClockwise) {
  EXPECT_DOUBLE_EQ(signed_angle({2, 0}, {0, 1}), std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(signed_angle({0, 1}, {3, 3}), -std::numbers::pi / 4);
  EXPECT_DOUBLE_EQ(signed_angle({-1, 0}, {1, 1e-9}), -(std::numbers::pi - 1e-9));
}

/// A square with a notch: the triangle that would fill the notch is left out.
TEST(Planar, TriangulationFillsTheInsideOfAChain) {
  Eigen::MatrixX2d points(5, 2);
  points << 0, 0, 2, 0, 2, 2, 1, 1, 0, 2;
  const std::vector<Eigen::Vector2i> chain{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}};
  const Eigen::MatrixX3i F = constrained_delaunay(points, chain);
  ASSERT_EQ(F.rows(), 3) << "n - 2 triangles in a polygon of n corners";
  double twice = 0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Vector2d a = points.row(F(t, 0)), b = points.row(F(t, 1)), c = points.row(F(t, 2));
    EXPECT_GT(cross(b - a, c - a), 0);
    twice += cross(b - a, c - a);
  }
  EXPECT_DOUBLE_EQ(twice, 6) << "the square's 4 less the notch's 1, doubled";
}

/// A square with a square hole, which a segment joins to a corner: 16 less 4 doubled is 24.
TEST(Planar, TriangulationLeavesHolesOut) {
  Eigen::MatrixX2d points(8, 2);
  points << 0, 0, 4, 0, 4, 4, 0, 4, 1, 1, 1, 3, 3, 3, 3, 1;
  const Eigen::MatrixX3i F = constrained_delaunay(points, {{0, 1, 2, 3}, {4, 5, 6, 7}}, {{0, 4}});
  ASSERT_EQ(F.rows(), 8) << "n triangles between two loops of n corners in all";
  double twice = 0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Vector2d a = points.row(F(t, 0)), b = points.row(F(t, 1)), c = points.row(F(t, 2));
    EXPECT_GT(cross(b - a, c - a), 0);
    twice += cross(b - a, c - a);
  }
  EXPECT_DOUBLE_EQ(twice, 24);
  points.row(3) << 2, 0;
  EXPECT_THROW(constrained_delaunay(points, {{4, 5, 6, 7}, {0, 1, 3}}, {}), Error)
      << "a point in the middle of a segment of a hole";
}

TEST(Planar, TriangulationRefusesEqualPointsAndCrossingSegments) {
  Eigen::MatrixX2d points(4, 2);
  points << 0, 0, 1, 1, 0, 1, 1, 0;
  EXPECT_THROW(constrained_delaunay(points, {{0, 1}, {2, 3}}), Error);
  points.row(3) = points.row(1);
  EXPECT_THROW(constrained_delaunay(points, {{0, 1}}), Error);
}

}  // namespace
}  // namespace geoprior
