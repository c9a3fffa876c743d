#include "metrics/developability/sharp_turning.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "core/angles.h"
#include "core/error.h"
#include "tests/metrics/sampled_surfaces.h"
#include "tests/metrics/shapes.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

TEST(SharpTurning, OfACubeIsAllInItsEdges) {
  // The diagonals of the faces do not turn.
  EXPECT_DOUBLE_EQ(sharp_turning_share(shapes::box({0, 0, 0}, {1, 1, 1})), 1);
  EXPECT_DOUBLE_EQ(sharp_turning_share(shapes::box({0, 0, 0}, {1, 2, 3}), 89 * kDegree), 1);
  EXPECT_EQ(sharp_turning_share(shapes::box({0, 0, 0}, {1, 1, 1}), 91 * kDegree), 0);
}

TEST(SharpTurning, OfAFlatSheetIsNone) {
  EXPECT_EQ(sharp_turning_share(sheets::rectangle(2, 1, 4, 3).mesh()), 0);
}

TEST(SharpTurning, OfAPrismChangesAtEighteenSides) {
  // n sides turn by 360 / n degrees each: 17 by 21.2, 19 by 18.9.
  for (const int m : {1, 3}) {
    EXPECT_NEAR(sharp_turning_share(sampled::prism(1, 0.5, 17, m)), 1, 1e-12);
    EXPECT_EQ(sharp_turning_share(sampled::prism(1, 0.5, 19, m)), 0);
    EXPECT_EQ(sharp_turning_share(sampled::prism(1, 0.5, 200, m)), 0);
  }
}

TEST(SharpTurning, OfAFoldBesideABendIsTheShareOfTheirAngles) {
  // Two lengths along one axis: a fold by 50 degrees, and facets of 5 degrees that turn by 90.
  const TriMesh fold = sheets::folded(2, 1, 4, 3, 50 * kDegree).mesh();
  EXPECT_NEAR(sharp_turning_share(fold), 1, 1e-12);
  const double radius = 0.1;
  const TriMesh bend =
      sheets::mapped(sheets::rectangle(radius * 95 * kDegree, 1, 19, 3), sheets::cylinder(radius))
          .mesh();
  const TriMesh both = shapes::together(fold, bend);
  EXPECT_NEAR(sharp_turning_share(both), 50.0 / (50 + 90), 1e-12);
  // Twice as large it is the same.
  EXPECT_NEAR(sharp_turning_share({2 * both.V, both.F}), 50.0 / (50 + 90), 1e-12);
}

TEST(SharpTurning, OfRoundedEdgesFallsUnderRefinementAndOfSharpOnesDoesNot) {
  EXPECT_GT(sharp_turning_share(shapes::sphere(1, {0, 0, 0}, 1)), 0.99);
  EXPECT_EQ(sharp_turning_share(shapes::sphere(1, {0, 0, 0}, 4)), 0);
  // A can of 90 sides: rims turn by 90 degrees over 2 pi r each, the wall by 360 over its height.
  const int n = 90;
  const double height = 0.5;
  TriMesh can = sampled::prism(1, height, n, 2);
  const Eigen::Index ring = 2 * n;
  can.V.conservativeResize(can.V.rows() + 2, 3);
  can.V.row(can.V.rows() - 2) << 0, 0, 0;
  can.V.row(can.V.rows() - 1) << 0, 0, height;
  const Eigen::Index wall = can.F.rows();
  can.F.conservativeResize(wall + 2 * n, 3);
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    can.F.row(wall + i) << next, i, 3 * n;
    can.F.row(wall + n + i) << static_cast<int>(ring) + i, static_cast<int>(ring) + next, 3 * n + 1;
  }
  const double rims = 2 * std::numbers::pi / 2, sides = height * 2 * std::numbers::pi;
  EXPECT_NEAR(sharp_turning_share(can), rims / (rims + sides), 1e-12);
}

TEST(SharpTurning, LeavesOutWhatIsMasked) {
  const TriMesh cube = shapes::box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(sharp_turning_share(cube, kSharpTurn, std::vector<bool>(8, true)), 0);
  // A fold that is wanted, beside a bend.
  const TriMesh fold = sheets::folded(2, 1, 4, 3, 50 * kDegree).mesh();
  std::vector<bool> ridge(fold.V.rows());
  for (int j = 0; j <= 3; ++j) ridge[2 * 4 + j] = true;
  EXPECT_EQ(sharp_turning_share(fold, kSharpTurn, ridge), 0);
  // One end alone leaves the edge.
  ridge.assign(ridge.size(), false);
  for (int j = 0; j <= 3; j += 2) ridge[2 * 4 + j] = true;
  EXPECT_NEAR(sharp_turning_share(fold, kSharpTurn, ridge), 1, 1e-12);
}

TEST(SharpTurning, DoesNotSeeBordersAndTrianglesWithoutArea) {
  TriMesh fold = sheets::folded(2, 1, 4, 3, 50 * kDegree).mesh();
  const Eigen::Index rows = fold.F.rows();
  fold.F.conservativeResize(rows + 1, 3);
  fold.F.row(rows) << 0, 0, 1;
  EXPECT_NEAR(sharp_turning_share(fold), 1, 1e-12);
}

TEST(SharpTurning, RefusesAThresholdAndAMaskThatSayNothing) {
  const TriMesh cube = shapes::box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(sharp_turning_share(cube, 0), Error);
  EXPECT_THROW(sharp_turning_share(cube, kSharpTurn, std::vector<bool>(7)), Error);
}

}  // namespace
}  // namespace geoprior
