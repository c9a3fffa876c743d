#include "baselines/fluid/liquid/pressure/solid_fractions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

GridShape shape_of(const Tank& tank) { return {tank.cells, tank.origin, tank.cell}; }

Tank cube_tank(int n) {
  Tank tank;
  tank.cells = {n, n, n};
  tank.cell = 1.0 / n;
  return tank;
}

TankSolid solid_ball(const Eigen::Vector3d& centre, double radius) {
  TankSolid solid;
  solid.name = "solid_ball";
  solid.shape.kind = LiquidShape::Kind::sphere;
  solid.shape.centre = centre;
  solid.shape.radius = radius;
  return solid;
}

SolidFractions sampled(const Tank& tank, double time = 0, double dt = 1e-3) {
  std::vector<ShapeDistance> distances;
  std::vector<PlacedSolid> placed;
  for (const TankSolid& solid : tank.solids) distances.emplace_back(solid.shape, tank.cell);
  for (std::size_t s = 0; s < tank.solids.size(); ++s)
    placed.push_back(place_solid(tank.solids[s], distances[s], time, dt));
  SolidFractions result;
  solid_fractions(tank, placed, shape_of(tank), result);
  return result;
}

/// Area of the faces normal to x at column i that is closed (m^2).
double closed_area(const SolidFractions& solids, int i, double cell) {
  double area = 0;
  for (int k = 0; k < solids.open[0].size.z(); ++k)
    for (int j = 0; j < solids.open[0].size.y(); ++j)
      area += (1 - static_cast<double>(solids.open[0](i, j, k))) * cell * cell;
  return area;
}

TEST(SolidFractions, AreaOfABallsSectionConvergesToSecondOrder) {
  const double radius = 0.31, offset = 0.1;
  const double exact = std::numbers::pi * (radius * radius - offset * offset);
  std::array<double, 2> errors{};
  for (std::size_t l = 0; l < 2; ++l) {
    const int n = 20 << (2 * l);
    Tank tank = cube_tank(n);
    tank.solids = {solid_ball({0.5 + offset, 0.503, 0.497}, radius)};
    errors[l] = std::abs(closed_area(sampled(tank), n / 2, tank.cell) - exact) / exact;
  }
  // Linear interpolation of the distance along edges errs by up to h^2 / (12 r) in the mean, chords
  // instead of arcs by h^2 / (12 r_section): relative to the section's area
  const double section = std::sqrt(radius * radius - offset * offset), h = 1.0 / 20;
  EXPECT_LE(errors[0], h * h / 6 * (1 / section + 1 / radius) / section);
  EXPECT_LE(errors[1], errors[0] / 8);  // 16 at second order
}

TEST(SolidFractions, APlaneCutsFacesAtTheFractionThatItLeaves) {
  // z = 0.34 cuts the fifth layer of cells of 1/10 ... 0.3 to 0.4: 60 % stays open.
  Tank tank = cube_tank(10);
  TankSolid floor;
  floor.shape.kind = LiquidShape::Kind::half_space;
  floor.shape.centre = {0, 0, 0.34};
  floor.shape.axis = Eigen::Vector3d::UnitZ();
  tank.solids = {floor};
  const SolidFractions solids = sampled(tank);
  EXPECT_NEAR(solids.open[0](4, 4, 3), 0.6, 1e-5);
  EXPECT_EQ(solids.open[0](4, 4, 2), 0);
  EXPECT_EQ(solids.open[0](4, 4, 4), 1);
  EXPECT_EQ(solids.open[2](4, 4, 3), 0);
  EXPECT_EQ(solids.open[2](4, 4, 4), 1);
}

TEST(SolidFractions, DiagonalCornersAreJoinedOrNotByTheCentre) {
  // Two balls near opposite corners of a face: the marching-squares case with two answers; open
  // area and closed area of the mirrored case add up to one.
  Tank tank = cube_tank(4);
  const double h = tank.cell;
  tank.solids = {solid_ball({0.5, 0.5, 0.5}, 0.5 * h),
                 solid_ball({0.5, 0.5 + h, 0.5 + h}, 0.5 * h)};
  const SolidFractions solids = sampled(tank);
  // Corners at distance 0.5 h inside, the other two at 0.5 h outside: the centre is on the border,
  // each triangle is 1/8 of the face.
  EXPECT_NEAR(solids.open[0](2, 2, 2), 0.75, 0.51);
  const float open = solids.open[0](2, 2, 2);
  EXPECT_TRUE(std::abs(open - 0.75F) < 1e-4F || std::abs(open - 0.25F) < 1e-4F) << open;
}

TEST(SolidFractions, ABoxAlongTheGridClosesItsFacesExactly) {
  Tank tank = cube_tank(10);
  TankSolid box;
  box.shape.centre = {0.5, 0.5, 0.2};
  box.shape.half_size = {0.2, 0.1, 0.2};
  tank.solids = {box};
  const SolidFractions solids = sampled(tank);
  EXPECT_EQ(solids.open[0](3, 4, 1), 0);  // its side
  EXPECT_EQ(solids.open[0](3, 3, 1), 1);  // beside it
  EXPECT_EQ(solids.open[2](4, 4, 4), 0);  // its top
  EXPECT_EQ(solids.open[2](2, 4, 4), 1);
  EXPECT_EQ(solids.open[1](2, 4, 1), 1);  // touches its edge from outside
}

TEST(SolidFractions, WallsAreClosedAndAnOpenTopIsOpen) {
  for (const bool open_top : {false, true}) {
    Tank tank = cube_tank(6);
    tank.open_top = open_top;
    const SolidFractions solids = sampled(tank);
    for (int a = 0; a < 3; ++a) {
      Eigen::Vector3i low(2, 3, 4), high(2, 3, 4);
      low[a] = 0;
      high[a] = 6;
      const ScalarGrid& open = solids.open[a];
      EXPECT_EQ(open(low.x(), low.y(), low.z()), 0);
      EXPECT_EQ(open(high.x(), high.y(), high.z()), open_top && a == 2 ? 1 : 0);
      EXPECT_EQ(open(3, 3, 3), 1);
    }
    EXPECT_NEAR(solids.distance(3, 3, 5), open_top ? 3.0 / 6 : 1.0 / 6, 1e-6);
    EXPECT_NEAR(solids.distance(3, 2, 1), 1.0 / 6, 1e-6);
    EXPECT_EQ(solids.distance(0, 2, 1), 0);
  }
}

TEST(SolidFractions, TheTopIsTheSideThatGravityPointsAwayFrom) {
  EXPECT_EQ(top_side({0, 0, -9.81}).axis, 2);
  EXPECT_TRUE(top_side({0, 0, -9.81}).upper);
  EXPECT_EQ(top_side({0.1, 9.81, 0}).axis, 1);
  EXPECT_FALSE(top_side({0.1, 9.81, 0}).upper);
  EXPECT_EQ(top_side({0, 0, 0}).axis, 2);
  Tank tank = cube_tank(5);
  tank.gravity = {0, 9.81, 0};
  const SolidFractions solids = sampled(tank);
  EXPECT_EQ(solids.open[1](2, 0, 2), 1);
  EXPECT_EQ(solids.open[1](2, 5, 2), 0);
  EXPECT_EQ(solids.open[2](2, 2, 5), 0);
}

TEST(SolidFractions, FacesCarryTheVelocityOfTheirBody) {
  Tank tank = cube_tank(20);
  TankSolid still = solid_ball({0.25, 0.3, 0.5}, 0.15), moving = solid_ball({0.7, 0.5, 0.5}, 0.15);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  moving.motion = Trajectory{{{0, {0, 0, 0}, Eigen::Quaterniond::Identity()},
                              {1, {0.02, 0, 0.05}, turn},
                              {2, {0.04, 0, 0.1}, turn * turn}}};
  tank.solids = {still, moving};
  const SolidFractions solids = sampled(tank, 1, 1e-6);
  // At the middle key: velocity (0.02, 0, 0.05) m/s and 0.4 rad/s about z through the centre.
  const Eigen::Vector3d centre(0.72, 0.5, 0.55);
  const GridShape shape = shape_of(tank);
  int checked = 0;
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 1; i < 20; ++i) {
        const double open = solids.open[0](i, j, k);
        const Eigen::Vector3d x = shape.node(i, j, k) + 0.5 * tank.cell * Eigen::Vector3d(0, 1, 1);
        if (open == 1 || x.x() < 0.45) {
          EXPECT_EQ(solids.velocity[0](i, j, k), 0);
          continue;
        }
        EXPECT_NEAR(solids.velocity[0](i, j, k), 0.02 - 0.4 * (x.y() - centre.y()), 1e-5);
        ++checked;
      }
  EXPECT_GT(checked, 100);
}

TEST(SolidSampler, MovingBodiesLeaveNothingBehind) {
  Tank tank = cube_tank(24);
  TankSolid still = solid_ball({0.5, 0.3, 0.3}, 0.2), moving = solid_ball({0.2, 0.5, 0.5}, 0.12);
  moving.motion =
      Trajectory{{{.time = 0, .shift = {0, 0, 0}}, {.time = 1, .shift = {0.6, 0.1, 0}}}};
  tank.solids = {moving, still};
  std::vector<ShapeDistance> distances;
  for (const TankSolid& solid : tank.solids) distances.emplace_back(solid.shape, tank.cell);
  SolidSampler sampler(tank, shape_of(tank));
  SolidFractions followed;
  for (const double time : {0.0, 0.1, 0.35, 0.4, 1.0}) {
    std::vector<PlacedSolid> placed;
    for (std::size_t s = 0; s < 2; ++s)
      placed.push_back(place_solid(tank.solids[s], distances[s], time, 0.01));
    sampler.sample(placed, followed);
    const SolidFractions fresh = sampled(tank, time, 0.01);
    EXPECT_EQ(followed.distance.values, fresh.distance.values) << time;
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_EQ(followed.open[a].values, fresh.open[a].values) << time;
      EXPECT_EQ(followed.velocity[a].values, fresh.velocity[a].values) << time;
    }
  }
}

TEST(SolidSampler, IsTheSameForAnyNumberOfThreads) {
  Tank tank = cube_tank(24);
  tank.solids = {solid_ball({0.5, 0.3, 0.3}, 0.2), solid_ball({0.4, 0.6, 0.3}, 0.25)};
  std::array<SolidFractions, 2> results;
  for (const int threads : {1, 2})
    with_threads(threads, [&] { results[threads - 1] = sampled(tank); });
  EXPECT_EQ(results[0].open[1].values, results[1].open[1].values);
  EXPECT_EQ(results[0].distance.values, results[1].distance.values);
}

TEST(SolidSampler, ABodyOutsideTheDomainClosesNothing) {
  Tank tank = cube_tank(8);
  tank.solids = {solid_ball({5, 5, 5}, 0.3)};
  const SolidFractions solids = sampled(tank);
  for (int i = 1; i < 8; ++i) EXPECT_EQ(closed_area(solids, i, tank.cell), 0);
}

TEST(SolidFractions, LiquidReachesIntoCutCells) {
  Tank tank = cube_tank(10);
  TankSolid floor;
  floor.shape.kind = LiquidShape::Kind::half_space;
  floor.shape.centre = {0, 0, 0.37};  // over the centres at 0.35
  floor.shape.axis = Eigen::Vector3d::UnitZ();
  tank.solids = {floor};
  const SolidFractions solids = sampled(tank);
  ScalarGrid distance(tank.cells, 0.3F);
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 10; ++i) {
      distance(i, j, 4) = -0.05F;
      distance(i, j, 3) = i < 5 ? 0.02F : 0.09F;  // particles nearby, or none
    }
  extend_into_solids(solids, shape_of(tank), distance);
  EXPECT_FLOAT_EQ(distance(2, 2, 3), -0.05F);
  EXPECT_FLOAT_EQ(distance(7, 2, 3), 0.09F);
  EXPECT_FLOAT_EQ(distance(2, 2, 4), -0.05F);
  EXPECT_FLOAT_EQ(distance(2, 2, 1), 0.3F);
}

}  // namespace
}  // namespace geoprior::fluid
