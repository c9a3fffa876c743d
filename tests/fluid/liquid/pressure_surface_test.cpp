#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "tests/fluid/liquid/pressure_fixture.h"

namespace geoprior::fluid {
namespace {

using std::numbers::pi;
using namespace pressure_test;

constexpr double kSurfaceGravity = 9.81, kDensity = 1000;

/// Still water of depth H in a box after gravity has pulled for dt: what the projection leaves.
struct Rest {
  double largest_speed = 0;           ///< m/s
  double largest_pressure_error = 0;  ///< Pa, against rho g (H - z)
};

Rest project_rest(const Tank& tank, double depth, double dt) {
  const GridShape shape = shape_of(tank);
  const SolidFractions solids = fractions_of(tank);
  const ScalarGrid distance =
      at_centres(shape, [&](const Eigen::Vector3d& x) { return x.z() - depth; });
  MacGrid velocity(shape);
  push(velocity, tank.gravity, dt);
  PressureSolver solver(shape);
  std::array<std::vector<char>, 3> valid;
  solver.project(solids, distance, nullptr, dt, kDensity, {.tolerance = 1e-9}, velocity, valid);
  Rest rest{largest_speed(velocity, valid), 0};
  for (int k = 0; k < shape.cells.z(); ++k)
    for (int j = 0; j < shape.cells.y(); ++j)
      for (int i = 0; i < shape.cells.x(); ++i) {
        const float p = solver.pressure()(i, j, k);
        if (p == 0) continue;
        const double expected =
            kDensity * kSurfaceGravity * (depth - shape.cell_centre(i, j, k).z());
        rest.largest_pressure_error = std::max(rest.largest_pressure_error, std::abs(p - expected));
      }
  return rest;
}

TEST(PressureSurface, StillWaterStaysStillWhereverItsSurfaceLies) {
  // p = rho g (H - z) is linear: the ghost-fluid surface reproduces it for any H between centres.
  Tank tank;
  tank.cells = {16, 16, 24};
  tank.cell = 1.0 / 24;
  for (const double cells : {12.02, 12.3, 12.51, 12.77, 13.0}) {
    const double depth = cells * tank.cell;
    const Rest rest = project_rest(tank, depth, 0.02);
    EXPECT_LE(rest.largest_speed, 1e-3 * std::sqrt(kSurfaceGravity * depth)) << cells;
    // Single precision of speeds g dt = 0.2 m/s.
    EXPECT_LE(rest.largest_speed, 2e-6) << cells;
    EXPECT_LE(rest.largest_pressure_error, 1e-5 * kDensity * kSurfaceGravity * depth) << cells;
  }
}

TEST(PressureSurface, AnOpenTopHoldsAPressureOfZeroOnTheBorder) {
  // Brimful: p = rho g (H - z) with H the domain's height.
  Tank tank;
  tank.cells = {6, 6, 10};
  tank.cell = 0.1;
  const Rest rest = project_rest(tank, 1.0, 0.02);
  EXPECT_LE(rest.largest_speed, 2e-6);
  EXPECT_LE(rest.largest_pressure_error, 1e-5 * kDensity * kSurfaceGravity);
}

TEST(PressureSurface, StillWaterStaysStillAroundABallAndASlantedFloor) {
  // Area fractions multiply both sides of the balance on a face: they do not disturb the rest.
  Tank tank;
  tank.cells = {24, 20, 24};
  tank.cell = 1.0 / 24;
  TankSolid ball;
  ball.shape.kind = LiquidShape::Kind::sphere;
  ball.shape.centre = {0.52, 0.41, 0.33};
  ball.shape.radius = 0.21;
  TankSolid floor;
  floor.shape.kind = LiquidShape::Kind::half_space;
  floor.shape.centre = {0, 0, 0.1};
  floor.shape.axis = Eigen::Vector3d(0.3, 0.1, 1).normalized();
  tank.solids = {ball, floor};
  const double depth = 0.613;
  const Rest rest = project_rest(tank, depth, 0.02);
  EXPECT_LE(rest.largest_speed, 1e-3 * std::sqrt(kSurfaceGravity * depth));
  EXPECT_LE(rest.largest_speed, 2e-6);
}

/// Largest error of the pressure against the harmonic function
///   f = 1/2 - z + a cos(pi x) cosh(pi z) / cosh(pi / 2),
/// whose zero level is a wave. The velocity given is grad f (u* . n = 0 on x = 0 and x = 1), solids
/// stand still: p = f (rho = dt = 1) leaves no velocity anywhere, the floor included.
double curved_surface_error(int n) {
  constexpr double kMiddle = 0.5;
  Tank tank;
  tank.cells = {n, 2, n};
  tank.cell = 1.0 / n;
  const GridShape shape = shape_of(tank);
  const double a = 0.1;
  const auto f = [&](const Eigen::Vector3d& x) {
    return kMiddle - x.z() + a * std::cos(pi * x.x()) * std::cosh(pi * x.z()) / std::cosh(pi / 2);
  };
  // The same zero level, but not proportional to the solution: theta is no better than its order.
  const ScalarGrid distance = at_centres(
      shape, [&](const Eigen::Vector3d& x) { return -f(x) * (1 + 0.5 * x.x() + x.z()); });
  const SolidFractions solids = fractions_of(tank);
  MacGrid velocity(shape);
  const double h = tank.cell;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 1; i < n; ++i) {
        const Eigen::Vector3d x = shape.node(i, j, k) + h * Eigen::Vector3d(0, 0.5, 0.5);
        velocity.face[0](i, j, k) = static_cast<float>(-a * pi * std::sin(pi * x.x()) *
                                                       std::cosh(pi * x.z()) / std::cosh(pi / 2));
      }
  for (int k = 1; k < n; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < n; ++i) {
        const Eigen::Vector3d x = shape.node(i, j, k) + h * Eigen::Vector3d(0.5, 0.5, 0);
        velocity.face[2](i, j, k) = static_cast<float>(
            -1 + a * pi * std::cos(pi * x.x()) * std::sinh(pi * x.z()) / std::cosh(pi / 2));
      }
  PressureSolver solver(shape);
  std::array<std::vector<char>, 3> valid;
  // A clamp of theta at 0.01 would add an error of up to 0.01 h, of first order.
  const PressureOptions options{.tolerance = 1e-10, .smallest_theta = 1e-6};
  solver.project(solids, distance, nullptr, 1, 1, options, velocity, valid);
  double largest = 0;
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i)
      if (distance(i, 0, k) < 0)
        largest =
            std::max(largest, std::abs(solver.pressure()(i, 0, k) - f(shape.cell_centre(i, 0, k))));
  return largest;
}

TEST(PressureSurface, ConvergesToSecondOrderAtACurvedFreeSurface) {
  const std::array<double, 3> errors{curved_surface_error(16), curved_surface_error(32),
                                     curved_surface_error(64)};
  for (std::size_t l = 0; l + 1 < errors.size(); ++l) {
    const double order = std::log2(errors[l] / errors[l + 1]);
    EXPECT_NEAR(order, 2, 0.35) << errors[l] << " to " << errors[l + 1];
  }
  EXPECT_NEAR(0.5 * std::log2(errors[0] / errors[2]), 2, 0.2);
}

TEST(PressureSurface, FreelyFallingWaterIsNotTouched) {
  // A ball of liquid in the air: a uniform velocity is divergence free, pressure 0.
  Tank tank;
  tank.cells = {20, 20, 20};
  tank.cell = 0.05;
  const GridShape shape = shape_of(tank);
  const ScalarGrid distance = at_centres(shape, [](const Eigen::Vector3d& x) {
    return (x - Eigen::Vector3d(0.5, 0.52, 0.47)).norm() - 0.22;
  });
  MacGrid velocity(shape);
  push(velocity, {0.3, -0.1, -2}, 1);
  PressureSolver solver(shape);
  std::array<std::vector<char>, 3> valid;
  solver.project(fractions_of(tank), distance, nullptr, 0.01, kDensity, {.tolerance = 1e-8},
                 velocity, valid);
  const std::array<float, 3> expected{0.3F, -0.1F, -2};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t f = 0; f < valid[a].size(); ++f)
      if (valid[a][f]) {
        ASSERT_NEAR(velocity.face[a].values[f], expected[a], 1e-6);
      }
}

TEST(PressureSurface, ThinAirGapsKeepTheirOwnPressure) {
  // Two blocks with one layer of air between, pushed together: p = 0 in the gap lets them move.
  Tank tank;
  tank.cells = {8, 4, 4};
  tank.cell = 1;
  tank.open_top = false;
  const GridShape shape = shape_of(tank);
  const ScalarGrid distance =
      at_centres(shape, [](const Eigen::Vector3d& x) { return 0.5 - std::abs(x.x() - 3.5); });
  MacGrid velocity(shape);
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j) velocity.face[0](3, j, k) = 1;
  PressureSolver solver(shape);
  std::array<std::vector<char>, 3> valid;
  const PressureReport report = solver.project(fractions_of(tank), distance, nullptr, 1, 1,
                                               {.tolerance = 1e-8}, velocity, valid);
  EXPECT_EQ(report.enclosed_regions, 0);
  EXPECT_EQ(report.liquid_cells, 7 * 16);
  EXPECT_EQ(solver.pressure()(3, 1, 1), 0);
}

TEST(PressureSurface, RefusesATimeStepOfZero) {
  Tank tank;
  tank.cells = {4, 4, 4};
  MacGrid velocity(shape_of(tank));
  std::array<std::vector<char>, 3> valid;
  PressureSolver solver(shape_of(tank));
  EXPECT_THROW(solver.project(fractions_of(tank), ScalarGrid(tank.cells, -1), nullptr, 0, 1000, {},
                              velocity, valid),
               Error);
}

}  // namespace
}  // namespace geoprior::fluid
