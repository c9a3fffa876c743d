#include "metrics/spacing/pattern_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

TEST(PatternMesh, OfAGridOfSquares) {
  const sheets::Sheet s = sheets::rectangle(0.3, 0.2, 6, 4);  // squares of 50 mm
  const PatternMeshSummary m = pattern_mesh(s.pattern, s.triangles);
  EXPECT_NEAR(m.area, 0.06, 1e-16);
  EXPECT_NEAR(m.min_area, 0.05 * 0.05 / 2, 1e-16);
  EXPECT_NEAR(m.min_altitude, 0.05 / std::sqrt(2), 1e-15);
  EXPECT_EQ(m.inverted, 0);
}

TEST(PatternMesh, SeesTurnedOverAndFlatTriangles) {
  sheets::Sheet s = sheets::rectangle(2, 2, 2, 2);
  // The middle vertex, at the origin, is carried over the border u = 1: the triangles that face it
  // turn over, and the signed areas still add up.
  s.pattern.row(4) << 1.5, 0.1;
  PatternMeshSummary m = pattern_mesh(s.pattern, s.triangles);
  EXPECT_EQ(m.inverted, 2);
  EXPECT_NEAR(m.area, 4, 1e-14);
  EXPECT_LT(m.min_altitude, 0);
  // Onto the border: they have no area.
  s.pattern.row(4) << 1, 0.1;
  m = pattern_mesh(s.pattern, s.triangles);
  EXPECT_EQ(m.inverted, 2);
  EXPECT_EQ(m.min_altitude, 0);
  EXPECT_THROW(pattern_mesh(s.pattern, s.triangles.topRows(0)), Error);
}

TEST(PatternMesh, MissingTriangleLeavesAHole) {
  const sheets::Sheet s = sheets::rectangle(0.3, 0.2, 6, 4);
  const Eigen::MatrixX3i fewer = s.triangles.bottomRows(s.triangles.rows() - 1);
  EXPECT_NEAR(pattern_mesh(s.pattern, fewer).area, 0.06 - 0.00125, 1e-16);
}

}  // namespace
}  // namespace geoprior
