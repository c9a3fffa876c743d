#include "metrics/contact/intersection_depth.h"

#include <gtest/gtest.h>

#include "metrics/contact/self_contact.h"
#include "tests/metrics/shapes.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

/// A horizontal square of side 2 and an upright one of side 1 that reaches `depth` below it.
TriMesh crossed(double depth) {
  const sheets::Sheet upright =
      sheets::mapped(sheets::rectangle(1, 1, 1, 1), [&](const Eigen::Vector2d& p) {
        return Eigen::Vector3d(p(0) + 0.03, 0.2, p(1) + 0.5 - depth);
      });
  return shapes::together(sheets::rectangle(2, 2, 1, 1).mesh(), upright.mesh());
}

TEST(IntersectionDepth, OfCrossedSquaresIsWhatIsBelow) {
  for (const double depth : {0.01, 0.1, 0.3}) {
    const TriMesh m = crossed(depth);
    EXPECT_GT(intersecting_pairs(m.V, m.F), 0);
    EXPECT_NEAR(intersection_depth(m.V, m.F), depth, 1e-15);
  }
  // More than half way through, the other side is nearer.
  const TriMesh m = crossed(0.9);
  EXPECT_NEAR(intersection_depth(m.V, m.F), 0.1, 1e-15);
}

TEST(IntersectionDepth, DoesNotDependOnPlaceAndOrder) {
  TriMesh m = crossed(0.2);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(2, 1, 2).normalized()).toRotationMatrix();
  m.V = (m.V * R.transpose()).rowwise() + Eigen::RowVector3d(3, 2, 1);
  EXPECT_NEAR(intersection_depth(m.V, m.F), 0.2, 1e-14);
  m.F = m.F.colwise().reverse().eval();
  EXPECT_NEAR(intersection_depth(m.V, m.F), 0.2, 1e-14);
}

TEST(IntersectionDepth, OfTouchingAndSeparateSheetsIsNone) {
  EXPECT_EQ(intersection_depth(crossed(0).V, crossed(0).F), 0);
  EXPECT_GT(intersecting_pairs(crossed(0).V, crossed(0).F), 0);  // touching counts there
  EXPECT_EQ(intersection_depth(crossed(-0.1).V, crossed(-0.1).F), 0);
  const sheets::Sheet folded = sheets::folded(0.2, 0.2, 6, 6, 2.5);
  EXPECT_EQ(intersection_depth(folded.x, folded.triangles), 0);
}

TEST(IntersectionDepth, OfNeighboursWithACommonVertexCounts) {
  // The free edge of the second triangle goes 0.1 through the first.
  TriMesh m;
  m.V.resize(5, 3);
  m.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.5, 0.2, 1, 0.3, 0.2, -0.1;
  m.F.resize(2, 3);
  m.F << 0, 1, 2, 0, 3, 4;
  ASSERT_EQ(intersecting_pairs(m.V, m.F), 1);
  EXPECT_NEAR(intersection_depth(m.V, m.F), 0.1, 1e-15);
}

TEST(IntersectingTriangles, AreThePairsInOrder) {
  const TriMesh first = shapes::sphere(1, {0, 0, 0}, 2);
  const TriMesh m = shapes::together(first, shapes::sphere(0.8, {0.63, 0.41, 0.29}, 2));
  const auto pairs = intersecting_triangles(m.V, m.F);
  EXPECT_EQ(static_cast<int>(pairs.size()), intersecting_pairs(m.V, m.F));
  EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
  for (const auto& [a, b] : pairs) {
    EXPECT_LT(a, first.triangle_count());
    EXPECT_GE(b, first.triangle_count());
  }
}

}  // namespace
}  // namespace geoprior
