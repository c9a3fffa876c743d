#include "metrics/isometry/isometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

using sheets::Sheet;

IsometrySummary of(const Sheet& s) { return isometry(s.pattern, s.x, s.triangles); }

TEST(Isometry, AFoldedSheetIsOne) {
  // Edges lie on the fold, so the polyhedron is isometric; sigma has the root of round-off.
  const Sheet s = sheets::mapped(sheets::rectangle(0.3, 0.2, 6, 5), sheets::fold(1.1));
  const IsometrySummary i = of(s);
  EXPECT_LT(i.rms, 1e-7);
  EXPECT_LT(i.max, 1e-7);
  EXPECT_LT(i.edge_error_max, 1e-14);
  EXPECT_NEAR(i.area_drift, 0, 1e-14);
}

TEST(Isometry, OfAnAffineStretchIsItsSingularValues) {
  const Sheet s = sheets::mapped(sheets::rectangle(0.3, 0.2, 4, 4, 0.2), [](const auto& p) {
    return Eigen::Vector3d(1.02 * p(0), 0, 0.99 * p(1));
  });
  const IsometrySummary i = of(s);
  EXPECT_NEAR(i.rms, std::sqrt((0.02 * 0.02 + 0.01 * 0.01) / 2), 1e-12);
  EXPECT_NEAR(i.max, 0.02, 1e-12);
  EXPECT_NEAR(i.edge_error_max, 0.02, 1e-12);  // the border has edges along u
  EXPECT_NEAR(i.area_drift, 1.02 * 0.99 - 1, 1e-12);
}

TEST(Isometry, IsWeightedByAreaInThePattern) {
  // The columns u > 0.05 of a sheet 0.1 wide are stretched by 10 %: half of the area, though they
  // have a fifth of the triangles.
  Sheet s = sheets::rectangle(0.1, 0.1, 10, 4);
  for (Eigen::Index v = 0; v < s.pattern.rows(); ++v) {
    const double column = s.pattern(v, 0) * 100 + 5;  // 0 … 10
    s.pattern(v, 0) = column <= 8 ? column / 160 : 0.05 + (column - 8) / 40;
  }
  s = sheets::mapped(s, [](const auto& p) {
    return Eigen::Vector3d(p(0) <= 0.05 ? p(0) : 0.05 + 1.1 * (p(0) - 0.05), p(1), 0);
  });
  const IsometrySummary i = of(s);
  EXPECT_NEAR(i.rms, std::sqrt(0.5 * 0.1 * 0.1 / 2), 1e-9);
  EXPECT_NEAR(i.area_drift, 0.05, 1e-12);
}

TEST(Isometry, EdgePercentileLeavesOutAFewEdges) {
  // One corner is pulled along its border edge: 2 of the 320 edges change, 1 by 50 %.
  Sheet s = sheets::rectangle(1, 1, 10, 10);
  s.x(0, 0) -= 0.05;
  const IsometrySummary i = of(s);
  EXPECT_NEAR(i.edge_error_max, 0.5, 1e-12);
  EXPECT_LT(i.edge_error_p95, 1e-12);
}

TEST(Isometry, OfAnInscribedCylinderFallsWithTheSquareOfTheEdge) {
  // A chord of an arc a at radius R is shorter by a^2 / (24 R^2).
  const double radius = 0.1;
  for (const int n : {10, 20, 40}) {
    const Sheet s = sheets::mapped(sheets::rectangle(0.2, 0.1, n, 5), sheets::cylinder(radius));
    const double arc = 0.2 / n;
    EXPECT_NEAR(of(s).max / (arc * arc / (24 * radius * radius)), 1, 0.01) << n;
  }
}

TEST(Isometry, RefusesOtherPoints) {
  const Sheet s = sheets::rectangle(1, 1, 2, 2);
  EXPECT_THROW(isometry(s.pattern, s.x.topRows(3), s.triangles), Error);
  EXPECT_THROW(isometry(s.pattern, s.x, s.triangles.topRows(0)), Error);
}

}  // namespace
}  // namespace geoprior
