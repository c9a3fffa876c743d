#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "baselines/fluid/liquid/pressure/solid_fractions.h"
#include "baselines/fluid/liquid/surface/isosurface.h"
#include "baselines/fluid/liquid/surface/liquid_surface.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "core/random.h"

namespace geoprior::fluid {
namespace {

using Inside = std::function<bool(const Eigen::Vector3d&)>;

GridShape unit_box(int n) { return {{n, n, n}, Eigen::Vector3d::Zero(), 1.0 / n}; }

/// Eight jittered particles in every cell, those inside kept, sorted.
LiquidParticles filled(const GridShape& shape, const Inside& inside) {
  LiquidParticles particles;
  RandomStream random(5, "particles");
  for (int k = 0; k < shape.cells.z(); ++k)
    for (int j = 0; j < shape.cells.y(); ++j)
      for (int i = 0; i < shape.cells.x(); ++i)
        for (int p = 0; p < 8; ++p) {
          const Eigen::Vector3d jitter(random.uniform(), random.uniform(), random.uniform());
          const Eigen::Vector3d octant(p & 1, (p >> 1) & 1, p >> 2);
          const Eigen::Vector3d x =
              shape.cell * (Eigen::Vector3d(i, j, k) + 0.5 * (octant + jitter));
          if (inside(shape.origin + x)) particles.position.push_back(x.cast<float>());
        }
  particles.velocity.assign(particles.position.size(), Eigen::Vector3f::Zero());
  sort_by_cell(shape, particles);
  return particles;
}

TriMesh skin(const GridShape& shape, const LiquidParticles& particles,
             const LiquidSurfaceOptions& options) {
  GridShape grid;
  const ScalarGrid field = liquid_field(shape, particles, options, grid);
  return isosurface(field, grid.origin, grid.cell);
}

struct KernelCase {
  SurfaceKernel kernel;
  double largest_offset;  ///< of the surface, in cells
};
class SurfaceFieldOf : public testing::TestWithParam<KernelCase> {};

// Measured on these particles: offsets of -0.02 h and -0.03 h on a pool, -0.1 h and -0.16 h on the
// small sphere, which both kernels shrink (the mean of a ball of neighbours lies inside a curved
// surface).
INSTANTIATE_TEST_SUITE_P(Kernels, SurfaceFieldOf,
                         testing::Values(KernelCase{SurfaceKernel::zhu_bridson, 0.2},
                                         KernelCase{SurfaceKernel::anisotropic, 0.25}));

TEST_P(SurfaceFieldOf, ASphereOfParticlesHasItsVolumeUpToAPartOfACell) {
  constexpr double kRadius = 0.3;
  const Eigen::Vector3d centre(0.5, 0.51, 0.49);
  std::array<double, 2> relative{};
  for (std::size_t l = 0; l < 2; ++l) {
    const GridShape shape = unit_box(16 << l);
    const LiquidParticles particles =
        filled(shape, [&](const Eigen::Vector3d& x) { return (x - centre).norm() < kRadius; });
    const TriMesh mesh = skin(shape, particles, {.kernel = GetParam().kernel});
    require_closed_manifold(mesh, "test", "sphere");
    EXPECT_EQ(mesh.vertex_count() - mesh.triangle_count() / 2, 2);
    const double volume = signed_volume(mesh.V, mesh.F);
    const double radius = std::cbrt(volume * 3 / (4 * std::numbers::pi));
    EXPECT_NEAR(radius, kRadius, GetParam().largest_offset * shape.cell);
    relative[l] = std::abs(radius / kRadius - 1);
    for (int v = 0; v < mesh.vertex_count(); ++v)
      EXPECT_NEAR((mesh.V.row(v).transpose() - centre).norm(), radius, 0.35 * shape.cell);
  }
  EXPECT_LE(relative[1], 0.65 * relative[0]);  // an offset in cells: first order
}

TEST_P(SurfaceFieldOf, APoolIsFlatAndMeetsTheWallsWithoutBumps) {
  const GridShape shape = unit_box(20);
  const double level = 0.46;
  // Particles keep half a cell off the walls, as they do in simulations.
  const double gap = 0.5 * shape.cell;
  const LiquidParticles particles = filled(shape, [&](const Eigen::Vector3d& x) {
    return x.z() < level && x.minCoeff() > gap && x.x() < 1 - gap && x.y() < 1 - gap;
  });
  const TriMesh mesh = skin(shape, particles, {.kernel = GetParam().kernel});
  require_closed_manifold(mesh, "test", "pool");
  double highest_wall = 0, lowest_wall = 1, highest = 0, lowest = 1;
  const double h = shape.cell, allowed = GetParam().largest_offset * h;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Eigen::Vector3d x = mesh.V.row(v);
    const double wall = std::min({x.x(), x.y(), 1 - x.x(), 1 - x.y()});
    EXPECT_GE(wall, 0.009 * h);
    if (x.z() < level - 1.5 * h) {
      // Sides and floor: on the walls to a fiftieth of a cell.
      EXPECT_LE(std::min(wall, x.z()), 0.021 * h);
      continue;
    }
    if (wall < 0.5 * h && wall > 0.02 * h) {
      highest_wall = std::max(highest_wall, x.z());
      lowest_wall = std::min(lowest_wall, x.z());
    }
    if (wall > 2 * h) {
      highest = std::max(highest, x.z());
      lowest = std::min(lowest, x.z());
    }
  }
  EXPECT_NEAR(0.5 * (highest + lowest), level, allowed);
  // Jittered particles leave ripples of a fifth of a cell; the rim by the wall is no different.
  EXPECT_LE(highest - lowest, 0.4 * h);
  EXPECT_LE(highest_wall, highest + 0.2 * h);
  EXPECT_GE(lowest_wall, lowest - 0.3 * h);
}

TEST_P(SurfaceFieldOf, IsTheSameForAnyNumberOfThreads) {
  const GridShape shape = unit_box(16);
  const LiquidParticles particles = filled(
      shape, [](const Eigen::Vector3d& x) { return x.z() < 0.4 + 0.1 * std::sin(7 * x.x()); });
  std::array<std::vector<float>, 2> fields;
  for (const int threads : {1, 2})
    with_threads(threads, [&] {
      GridShape grid;
      fields[threads - 1] =
          liquid_field(shape, particles, {.kernel = GetParam().kernel}, grid).values;
    });
  EXPECT_EQ(fields[0], fields[1]);
}

TEST_P(SurfaceFieldOf, RandomSprayGivesClosedManifolds) {
  const GridShape shape = unit_box(12);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomStream random(seed, "spray");
    LiquidParticles particles;
    for (int p = 0; p < 400 + 200 * static_cast<int>(seed); ++p)
      particles.position.emplace_back(
          Eigen::Vector3d(random.uniform(), random.uniform(), random.uniform()).cast<float>());
    particles.velocity.assign(particles.position.size(), Eigen::Vector3f::Zero());
    sort_by_cell(shape, particles);
    LiquidSurfaceOptions options{.kernel = GetParam().kernel};
    options.cells_per_cell = seed % 2 == 0 ? 1 : 1.7;
    const TriMesh mesh = skin(shape, particles, options);
    EXPECT_GT(mesh.triangle_count(), 0);
    EXPECT_NO_THROW(require_closed_manifold(mesh, "test", "spray"));
  }
}

TEST(SurfaceField, ASingleParticleIsABallOfItsRadius) {
  // xbar is the particle itself: the zero level of |x - x_p| - r_p is a sphere.
  const GridShape shape = unit_box(10);
  const Eigen::Vector3d place(0.52, 0.47, 0.55);
  LiquidParticles particles;
  particles.position.push_back(place.cast<float>());
  particles.velocity.assign(1, Eigen::Vector3f::Zero());
  sort_by_cell(shape, particles);
  GridShape grid;
  const ScalarGrid field =
      liquid_field(shape, particles, {.cells_per_cell = 4, .smoothing = 0}, grid);
  EXPECT_EQ(field.size, Eigen::Vector3i(41, 41, 41));
  EXPECT_DOUBLE_EQ(grid.cell, 0.025);
  for (int k = 1; k < 40; ++k)
    for (int j = 1; j < 40; ++j)
      for (int i = 1; i < 40; ++i) {
        const double d = (grid.node(i, j, k) - place).norm();
        EXPECT_EQ(field(i, j, k) < 0, d < 0.05) << d;
      }
  const TriMesh mesh = isosurface(field, grid.origin, grid.cell);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    EXPECT_NEAR((mesh.V.row(v).transpose() - place).norm(), 0.05, 0.004);
}

TEST(SurfaceField, IsTheDistanceToAFlatSurface) {
  // Particles on a fine lattice fill z < 1/2: the mapped field is z - 1/2 from R/2 = h below to R
  // above, up to the lattice (a quarter of whose step is 1/16 h) and single precision.
  const GridShape shape = unit_box(8);
  LiquidParticles particles;
  for (int k = 0; k < 32; ++k)
    for (int j = 0; j < 64; ++j)
      for (int i = 0; i < 64; ++i)
        particles.position.emplace_back((Eigen::Vector3d(i, j, k).array() + 0.5).cast<float>() /
                                        64);
  particles.velocity.assign(particles.position.size(), Eigen::Vector3f::Zero());
  sort_by_cell(shape, particles);
  GridShape grid;
  const ScalarGrid field =
      liquid_field(shape, particles, {.cells_per_cell = 2, .smoothing = 0}, grid);
  const double h = shape.cell;
  for (int k = 1; k < 16; ++k) {
    const double expected = std::clamp(grid.node(8, 8, k).z() - 0.5, -h, 2 * h);
    // The level of the kernel radius 4 r_p lies at +0.0065 R, see the profile.
    EXPECT_NEAR(field(8, 8, k), expected, 0.03 * h) << k;
  }
}

TEST(SurfaceField, TwoDropsApartDoNotGrowAPhantomBetweenThem) {
  // The mean place of two clusters lies between them, where nothing is: the reason of the fix by
  // the eigenvalue of grad xbar. Nodes midway must stay outside.
  const GridShape shape = unit_box(16);
  const double h = shape.cell;
  const Eigen::Vector3d a(0.5 - 1.6 * h, 0.5, 0.5), b(0.5 + 1.6 * h, 0.5, 0.5);
  const LiquidParticles particles = filled(shape, [&](const Eigen::Vector3d& x) {
    return (x - a).norm() < 0.9 * h || (x - b).norm() < 0.9 * h;
  });
  GridShape grid;
  const ScalarGrid field =
      liquid_field(shape, particles, {.cells_per_cell = 2, .smoothing = 0}, grid);
  for (int j = 14; j <= 18; ++j)
    for (int k = 14; k <= 18; ++k) EXPECT_GT(field(16, j, k), 0) << j << ' ' << k;
  EXPECT_LT(field(13, 16, 16), 0);
  EXPECT_LT(field(19, 16, 16), 0);
}

TEST(SurfaceField, LiquidTouchesASolidWithoutAGap) {
  // Particles keep half a cell off a ball under water; the skin of the liquid lies on the ball.
  Tank tank;
  tank.cells = {24, 24, 24};
  tank.cell = 1.0 / 24;
  TankSolid ball;
  ball.shape.kind = LiquidShape::Kind::sphere;
  ball.shape.centre = {0.5, 0.52, 0.4};
  ball.shape.radius = 0.2;
  tank.solids = {ball};
  const GridShape shape{tank.cells, tank.origin, tank.cell};
  const ShapeDistance distance(ball.shape, tank.cell);
  const std::array<PlacedSolid, 1> placed{place_solid(ball, distance, 0, 0)};
  SolidFractions solids;
  solid_fractions(tank, placed, shape, solids);
  const double level = 0.79;
  const LiquidParticles particles = filled(shape, [&](const Eigen::Vector3d& x) {
    return x.z() < level && distance(x) > 0.5 * shape.cell;
  });
  GridShape grid;
  ScalarGrid field = liquid_field(shape, particles, {}, grid);
  meet_solids(shape, solids, grid, field);
  const TriMesh mesh = isosurface(field, grid.origin, grid.cell);
  require_closed_manifold(mesh, "test", "pool with ball");
  int on_ball = 0;
  double largest = 0, sum = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double d = distance(mesh.V.row(v));
    if (d > 1.5 * shape.cell) continue;
    ++on_ball;
    sum += d;
    largest = std::max(largest, std::abs(d));
  }
  // Linear interpolation on a ball of five cells errs by h^2 / 8 / (5 h), jitter adds as much.
  EXPECT_LE(largest, 0.1 * shape.cell);
  EXPECT_NEAR(sum / on_ball, 0, 0.03 * shape.cell);
  // Area of the ball over the area of a marching-cubes vertex, about h^2.
  EXPECT_GT(on_ball, 4 * std::numbers::pi * 0.04 / (tank.cell * tank.cell));
}

TEST(SurfaceField, VelocityOfVerticesIsTheGridsTrilinearOne) {
  const GridShape shape = unit_box(8);
  MacGrid velocity(shape);
  // u = (2x, -y, 3 - z): linear, so that trilinear interpolation is exact away from the border.
  for (int k = 0; k < 9; ++k)
    for (int j = 0; j < 9; ++j)
      for (int i = 0; i < 9; ++i) {
        if (j < 8 && k < 8) velocity.face[0](i, j, k) = static_cast<float>(2 * i * shape.cell);
        if (i < 8 && k < 8) velocity.face[1](i, j, k) = static_cast<float>(-j * shape.cell);
        if (i < 8 && j < 8) velocity.face[2](i, j, k) = static_cast<float>(3 - k * shape.cell);
      }
  Eigen::MatrixX3d points(2, 3);
  points << 0.31, 0.52, 0.77, 0.5, 0.21, 0.4;
  const Eigen::MatrixX3d u = surface_velocity(velocity, points);
  for (int p = 0; p < 2; ++p) {
    EXPECT_NEAR(u(p, 0), 2 * points(p, 0), 1e-6);
    EXPECT_NEAR(u(p, 1), -points(p, 1), 1e-6);
    EXPECT_NEAR(u(p, 2), 3 - points(p, 2), 1e-6);
  }
}

TEST(SurfaceField, RefusesUnsortedParticles) {
  LiquidParticles particles;
  particles.position.emplace_back(0.5F, 0.5F, 0.5F);
  GridShape grid;
  EXPECT_THROW(liquid_field(unit_box(4), particles, {}, grid), Error);
}

}  // namespace
}  // namespace geoprior::fluid
