#include <gtest/gtest.h>

#include "tests/fluid/liquid/pressure_fixture.h"

namespace geoprior::fluid {
namespace {

using namespace pressure_test;

TEST(PressureSolids, APistonPushesTheLiquidAheadOfIt) {
  // A box across the whole channel moves along +x at 1/2 m/s; the liquid ahead can only leave
  // upwards. Flux through every cross section ahead of it: what the piston sweeps.
  Tank tank;
  tank.cells = {32, 4, 16};
  tank.cell = 1.0 / 16;
  TankSolid piston;
  piston.shape.centre = {0.2, 0.125, 0.5};
  piston.shape.half_size = {0.2 + 1.0 / 64, 1, 2};  // its front cuts cells
  piston.motion = Trajectory{{{.time = 0, .shift = {0, 0, 0}},
                              {.time = 2, .shift = {0.5, 0, 0}},
                              {.time = 4, .shift = {1, 0, 0}},
                              {.time = 6, .shift = {1.5, 0, 0}}}};
  tank.solids = {piston};
  const GridShape shape = shape_of(tank);
  const double time = 2, dt = 1e-3;
  const SolidFractions solids = fractions_of(tank, time, dt);
  const Bodies bodies(tank, time, dt);
  const double speed = bodies.placed[0].linear.x();
  ASSERT_NEAR(speed, 0.25, 1e-3);
  const double depth = 0.53;
  const ScalarGrid distance =
      at_centres(shape, [&](const Eigen::Vector3d& x) { return x.z() - depth; });
  MacGrid velocity(shape);
  PressureSolver solver(shape);
  std::array<std::vector<char>, 3> valid;
  const PressureReport report =
      solver.project(solids, distance, nullptr, dt, 1000, {.tolerance = 1e-8}, velocity, valid);
  EXPECT_TRUE(report.converged);
  // Far ahead the flow is a uniform rise only where it must be: nothing passes the end wall.
  for (int k = 0; k < 8; ++k) EXPECT_EQ(velocity.face[0](32, 1, k), 0);
  // The faces of the cells that the front cuts carry no open part; the next ones take the flux.
  const int front = static_cast<int>((0.4 + 1.0 / 64 + 0.5) / tank.cell);
  double flux = 0;  // through the plane x = front + 1 below the surface layer
  for (int k = 0; k < 8; ++k) flux += velocity.face[0](front + 1, 1, k) * tank.cell;
  double risen = 0;
  for (int i = front + 1; i < 32; ++i) risen += velocity.face[2](i, 1, 8) * tank.cell;
  EXPECT_NEAR(flux, risen, 1e-6);
  // All that the piston sweeps below z = 8 h rises, over the cut cell or beyond it.
  const double swept = speed * 8 * tank.cell;
  const double over_cut_cell =
      solids.open[2](front, 1, 8) * velocity.face[2](front, 1, 8) * tank.cell;
  EXPECT_NEAR(flux + over_cut_cell, swept, 1e-5);
}

TEST(PressureSolids, ABallThatMovesWithTheLiquidLeavesItAlone) {
  // Liquid and solid at one velocity: the fractions must not make sources of the cut faces.
  Tank tank;
  tank.cells = {20, 20, 20};
  tank.cell = 0.05;
  tank.open_top = true;
  TankSolid ball;
  ball.shape.kind = LiquidShape::Kind::sphere;
  ball.shape.centre = {0.5, 0.5, 0.5};
  ball.shape.radius = 0.18;
  ball.motion = Trajectory{{{.time = 0, .shift = {0, 0, 0}}, {.time = 1, .shift = {0.1, 0, 0.05}}}};
  tank.solids = {ball};
  const GridShape shape = shape_of(tank);
  const SolidFractions solids = fractions_of(tank, 0.5);
  const Bodies bodies(tank, 0.5);
  const Eigen::Vector3d u = bodies.placed[0].linear;
  // A larger ball of liquid around it, in the air: no wall is near.
  const Eigen::Vector3d centre = bodies.placed[0].centre;
  const ScalarGrid distance =
      at_centres(shape, [&](const Eigen::Vector3d& x) { return (x - centre).norm() - 0.35; });
  MacGrid velocity(shape);
  push(velocity, u, 1);
  PressureSolver solver(shape);
  std::array<std::vector<char>, 3> valid;
  solver.project(solids, distance, nullptr, 0.01, 1000, {}, velocity, valid);
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t f = 0; f < valid[a].size(); ++f)
      if (valid[a][f]) {
        ASSERT_NEAR(velocity.face[a].values[f], u[a], 1e-6);
      }
}

TEST(PressureSolids, AFullClosedBoxHasAPressureUpToAConstant) {
  Tank tank;
  tank.cells = {12, 10, 8};
  tank.cell = 0.1;
  tank.open_top = false;
  const GridShape shape = shape_of(tank);
  MacGrid velocity(shape);
  push(velocity, tank.gravity, 0.01);
  PressureSolver solver(shape);
  std::array<std::vector<char>, 3> valid;
  const PressureReport report =
      solver.project(fractions_of(tank), ScalarGrid(tank.cells, -1), nullptr, 0.01, 1000,
                     {.tolerance = 1e-8}, velocity, valid);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.enclosed_regions, 1);
  EXPECT_LE(largest_speed(velocity, valid), 1e-6);
  double mean = 0;
  for (const float p : solver.pressure().values) mean += p;
  EXPECT_NEAR(mean / static_cast<double>(shape.cell_count()), 0, 1e-2);
  // rho g times the height between two centres.
  EXPECT_NEAR(solver.pressure()(5, 5, 1) - solver.pressure()(5, 5, 6), 1000 * 9.81 * 0.5, 0.05);
}

TEST(PressureSolids, EveryEnclosedRegionLosesItsOwnMean) {
  // A wall of one cell parts a full closed box; a piston face squeezes the left half: its volume
  // cannot be kept, the right half does not notice.
  Tank tank;
  tank.cells = {13, 4, 4};
  tank.cell = 1;
  tank.open_top = false;
  TankSolid wall;
  wall.shape.centre = {6.5, 2, 2};
  wall.shape.half_size = {0.5, 3, 3};
  tank.solids = {wall};
  const GridShape shape = shape_of(tank);
  SolidFractions solids = fractions_of(tank);
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j) solids.velocity[0](0, j, k) = 0.6F;
  MacGrid velocity(shape);
  PressureSolver solver(shape);
  std::array<std::vector<char>, 3> valid;
  const PressureReport report = solver.project(solids, ScalarGrid(tank.cells, -1), nullptr, 0.01,
                                               1000, {.tolerance = 1e-9}, velocity, valid);
  EXPECT_EQ(report.enclosed_regions, 2);
  EXPECT_TRUE(report.converged);
  // The excess of 0.6 m/s spreads evenly over six cells.
  for (int i = 0; i <= 6; ++i) EXPECT_NEAR(velocity.face[0](i, 1, 2), 0.6 * (6 - i) / 6.0, 1e-6);
  for (int i = 7; i <= 13; ++i) EXPECT_NEAR(velocity.face[0](i, 1, 2), 0, 1e-7);
}

TEST(PressureSolids, OnlyFacesBesideLiquidChange) {
  Tank tank;
  tank.cells = {10, 10, 10};
  tank.cell = 0.1;
  const GridShape shape = shape_of(tank);
  const ScalarGrid distance =
      at_centres(shape, [](const Eigen::Vector3d& x) { return x.z() - 0.43; });
  MacGrid velocity(shape);
  for (ScalarGrid& face : velocity.face)
    for (std::size_t f = 0; f < face.values.size(); ++f)
      face.values[f] = static_cast<float>(f % 7) - 3;
  const MacGrid before = velocity;
  PressureSolver solver(shape);
  std::array<std::vector<char>, 3> valid;
  solver.project(fractions_of(tank), distance, nullptr, 0.01, 1000, {}, velocity, valid);
  // Centres at 0.05 … 0.35 are liquid: faces normal to z up to 0.4, others up to that row.
  for (int k = 0; k < 11; ++k) {
    EXPECT_EQ(valid[2][velocity.face[2].index(4, 4, k)], k <= 4) << k;
    if (k > 4) {
      EXPECT_EQ(velocity.face[2](4, 4, k), before.face[2](4, 4, k)) << k;
    }
  }
  for (int k = 0; k < 10; ++k) EXPECT_EQ(valid[0][velocity.face[0].index(4, 4, k)], k < 4) << k;
  // Walls: the liquid there has the wall's normal velocity.
  EXPECT_EQ(valid[0][velocity.face[0].index(0, 4, 2)], 1);
  EXPECT_EQ(velocity.face[0](0, 4, 2), 0);
  EXPECT_EQ(velocity.face[0](0, 4, 7), before.face[0](0, 4, 7));
}

}  // namespace
}  // namespace geoprior::fluid
