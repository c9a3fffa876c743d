#include "metrics/spacing/pattern_grid.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

double cross(const Eigen::RowVector2d& a, const Eigen::RowVector2d& b, const Eigen::Vector2d& p) {
  return (b(0) - a(0)) * (p(1) - a(1)) - (b(1) - a(1)) * (p(0) - a(0));
}

TEST(PatternGrid, EveryPointHasTheTriangleThatContainsIt) {
  const sheets::Sheet s = sheets::turned_pattern(sheets::rectangle(0.3, 0.2, 9, 7, 0.3), 0.4);
  const PatternGrid grid = pattern_grid(s.pattern, s.triangles, 2.5e-3);
  int inside = 0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const int t = grid.at(i, j);
      if (t < 0) continue;
      ++inside;
      for (int k = 0; k < 3; ++k) {
        EXPECT_GE(cross(s.pattern.row(s.triangles(t, k)),
                        s.pattern.row(s.triangles(t, (k + 1) % 3)), grid.point(i, j)),
                  -1e-15);
      }
    }
  }
  EXPECT_NEAR(inside * 2.5e-3 * 2.5e-3 / 0.06, 1, 0.01);
}

TEST(PatternGrid, IsTheSameForEveryMeshOfAPattern) {
  const sheets::Sheet coarse = sheets::rectangle(0.21, 0.29, 3, 4, 0.2);
  const sheets::Sheet fine = sheets::rectangle(0.21, 0.29, 30, 40, 0.3);
  const PatternGrid a = pattern_grid(coarse.pattern, coarse.triangles, 5e-3);
  const PatternGrid b = pattern_grid(fine.pattern, fine.triangles, 5e-3);
  ASSERT_EQ(a.triangle.size(), b.triangle.size());
  EXPECT_EQ(a.point(3, 5), b.point(3, 5));
  EXPECT_EQ(std::count(a.triangle.begin(), a.triangle.end(), -1), 0);  // 42 x 58 points, all inside
  EXPECT_EQ(std::count(b.triangle.begin(), b.triangle.end(), -1), 0);
  EXPECT_EQ(a.triangle.size(), 42u * 58u);
}

TEST(PatternGrid, AHoleAndTheOutsideAreEmpty) {
  sheets::Sheet s = sheets::rectangle(0.3, 0.3, 3, 3);
  // Without the middle square, whose triangles are rows 8 and 9.
  Eigen::MatrixX3i ring(16, 3);
  ring << s.triangles.topRows(8), s.triangles.bottomRows(8);
  const PatternGrid grid = pattern_grid(s.pattern, ring, 5e-3);
  EXPECT_EQ(grid.at(30, 30), -1);
  EXPECT_GE(grid.at(10, 10), 0);
  EXPECT_EQ(std::count(grid.triangle.begin(), grid.triangle.end(), -1), 20 * 20);
  EXPECT_EQ(grid.at(-1, 0), -1);
  EXPECT_EQ(grid.at(0, grid.rows), -1);
}

TEST(PatternGrid, RefusesWhatItCannotHold) {
  const sheets::Sheet s = sheets::rectangle(1, 1, 2, 2);
  EXPECT_THROW(pattern_grid(s.pattern, s.triangles, 0), Error);
  EXPECT_THROW(pattern_grid(s.pattern, s.triangles, 1e-5), Error);
  EXPECT_THROW(pattern_grid(s.pattern, s.triangles.topRows(0), 0.1), Error);
}

}  // namespace
}  // namespace geoprior
