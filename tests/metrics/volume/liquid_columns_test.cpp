#include "metrics/volume/liquid_columns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "metrics/volume/dam_break.h"
#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

// Probes fall on vertices, edges and diagonals of the boxes on purpose: each crossing counts once.
TEST(Columns, OfTwoStackedBoxesAddTheirDepths) {
  const TriMesh boxes =
      shapes::together(shapes::box({0, 0, 0}, {4, 4, 1}), shapes::box({1, 1, 2}, {3, 3, 2.5}));
  const ColumnGrid grid{{-0.5, -0.5}, 1, 5, 5};  // probes at whole numbers 0 … 4
  const Columns c = columns(boxes, grid);
  EXPECT_DOUBLE_EQ(c.depth[grid.index(2, 2)], 1.5);
  EXPECT_DOUBLE_EQ(c.top[grid.index(2, 2)], 2.5);
  double area = 0;
  for (const double depth : c.depth) {
    EXPECT_TRUE(depth == 0 || depth == 1 || depth == 1.5) << depth;
    area += depth > 0 ? 1 : 0;
  }
  EXPECT_EQ(area, 16);  // half-open squares: 4 x 4 of the 5 x 5 probes
}

TEST(Columns, IntegrateToTheVolumeOfASphere) {
  const TriMesh sphere = shapes::sphere(1, {0.1, 0.2, 0.3}, 5);
  const ColumnGrid grid = covering_grid(sphere.V, 0.01);
  const double volume = columns(sphere, grid).depth.sum() * grid.spacing * grid.spacing;
  // The polyhedron's own volume; what is left is the midpoint rule's error at the rim, O(h^1.5).
  EXPECT_NEAR(volume, signed_volume(sphere.V, sphere.F), 2e-3);
}

TEST(Columns, AreAbsentBesideTheSurface) {
  const ColumnGrid grid{{5, 5}, 1, 2, 2};
  const Columns c = columns(shapes::box({0, 0, 0}, {1, 1, 1}), grid);
  for (Eigen::Index i = 0; i < grid.count(); ++i) {
    EXPECT_TRUE(std::isnan(c.top[i]));
    EXPECT_EQ(c.depth[i], 0);
  }
  TriMesh bad = shapes::box({0, 0, 0}, {1, 1, 1});
  bad.V(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(columns(bad, grid), Error);
}

TEST(CompareColumns, FindsRmsAndCorrelation) {
  const Eigen::VectorXd wave = Eigen::VectorXd::LinSpaced(64, 0, 63).unaryExpr(
      [](double i) { return std::sin(2 * std::numbers::pi * i / 64); });
  const ColumnComparison shifted = compare_columns(wave, (wave.array() + 0.25).matrix());
  EXPECT_NEAR(shifted.rms, 0.25, 1e-15);
  EXPECT_NEAR(shifted.correlation, 1, 1e-15);
  EXPECT_NEAR(compare_columns(wave, -wave).correlation, -1, 1e-15);
  Eigen::VectorXd gap = wave;
  gap[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(compare_columns(wave, gap).probes, 63);
  EXPECT_THROW(compare_columns(wave, wave.head(3)), Error);
}

// h = t^2 c has the second difference 2 c.
TEST(SecondDifference, OfAParabolaIsConstant) {
  const Eigen::Vector2d c(0.5, -3);
  EXPECT_DOUBLE_EQ(largest_second_difference(0 * c, 1 * c, 4 * c), 6);
}

TEST(DamBreak, FrontAndHeightOfABlockOfWater) {
  const TriMesh block = shapes::box({0, 0, 0}, {0.43, 0.2, 0.1});
  const ColumnGrid grid{{0, 0}, 0.02, 50, 10};
  const Columns c = columns(block, grid);
  EXPECT_NEAR(dam_front(block, c, grid, 0.01), 0.43, grid.spacing / 1000);
  EXPECT_NEAR(dam_height(c, grid), 0.1, 1e-15);
  EXPECT_TRUE(std::isnan(dam_front(block, c, grid, 0.2)));
}

// The face of a block stands anywhere between two probes, the water may reach the far wall, and a
// wedge of 0.1 m to 0 over 1 m is 0.025 m deep at x = 0.75.
TEST(DamBreak, FrontDoesNotDependOnWhereTheProbesStand) {
  const ColumnGrid grid{{0, 0}, 0.02, 50, 10};
  const double within = grid.spacing / 1000;
  for (const double front : {0.411, 0.42, 0.429, 0.995, 1.0}) {
    const TriMesh block = shapes::box({0, 0, 0}, {front, 0.2, 0.1});
    EXPECT_NEAR(dam_front(block, columns(block, grid), grid, 0.01), front, within);
  }
  TriMesh wedge = shapes::box({0, 0, 0}, {1, 0.2, 0.1});
  for (Eigen::Index v = 0; v < wedge.V.rows(); ++v) {
    if (wedge.V(v, 0) == 1 && wedge.V(v, 2) > 0) wedge.V(v, 2) = 0;
  }
  EXPECT_NEAR(dam_front(wedge, columns(wedge, grid), grid, 0.025), 0.75, within);
}

TEST(DamBreak, MeasuredCurvesAreMonotone) {
  for (std::size_t i = 1; i < measured_dam_front().size(); ++i) {
    EXPECT_GT(measured_dam_front()[i].value, measured_dam_front()[i - 1].value);
  }
  for (std::size_t i = 1; i < measured_dam_height().size(); ++i) {
    EXPECT_LT(measured_dam_height()[i].value, measured_dam_height()[i - 1].value);
  }
  EXPECT_DOUBLE_EQ(interpolate(measured_dam_front(), 0.41), 1.11);
  EXPECT_NEAR(interpolate(measured_dam_height(), 0.665), 0.915, 1e-12);
  EXPECT_TRUE(std::isnan(interpolate(measured_dam_front(), 9)));
}

}  // namespace
}  // namespace geoprior
