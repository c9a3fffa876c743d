#include "baselines/fluid/liquid/grid/advection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baselines/fluid/liquid/grid/extrapolation.h"
#include "baselines/fluid/liquid/grid/mac_grid_sampler.h"
#include "baselines/fluid/liquid/particles/transfer.h"
#include "baselines/fluid/liquid/particles/volume_correction.h"
#include "tests/core/geometry/shapes.h"
#include "tests/fluid/liquid/fixture.h"
#include "tests/fluid/liquid/standard_flows.h"

namespace geoprior::fluid {
namespace {

using flows::advect;
using flows::sample_field;
using std::numbers::pi;
using tanks::grid_of;

float furthest(const std::vector<Eigen::Vector3f>& a, const std::vector<Eigen::Vector3f>& b) {
  float most = 0;
  for (std::size_t p = 0; p < a.size(); ++p) most = std::max(most, (a[p] - b[p]).norm());
  return most;
}

/// The three stages of the header for one particle, in metres.
Eigen::Vector3d ralston(const MacGrid& velocity, double dt, const Eigen::Vector3d& x) {
  const Eigen::Vector3d k1 = velocity_at(velocity, x);
  const Eigen::Vector3d k2 = velocity_at(velocity, x + dt / 2 * k1);
  const Eigen::Vector3d k3 = velocity_at(velocity, x + 3 * dt / 4 * k2);
  return x + dt / 9 * (2 * k1 + 3 * k2 + 4 * k3);
}

TEST(LiquidAdvection, BatchesOfEightMoveAsRalstonsMethodMovesOne) {
  MacGrid grid(grid_of({12, 10, 8}, 0.1));
  RandomStream random(3, "velocity");
  for (ScalarGrid& face : grid.face)
    for (float& u : face.values) u = static_cast<float>(random.normal());
  // Two cells from walls, and moved by one at most: nothing is put back inside.
  const LiquidParticles before = tanks::scattered(203, {0.2, 0.2, 0.2}, {1.0, 0.8, 0.6}, 4);
  LiquidParticles after = before;
  advect(grid, 0.02, after);
  for (std::size_t p = 0; p < before.size(); ++p) {
    const Eigen::Vector3d expected = ralston(grid, 0.02, before.position[p].cast<double>());
    // Single precision of numbers up to 1 m.
    EXPECT_LT((after.position[p].cast<double>() - expected).norm(), 1e-6) << p;
  }
}

TEST(LiquidAdvection, RungeKuttaIsOfThirdOrder) {
  MacGrid grid(grid_of({64, 64, 2}, 1.0 / 64));
  sample_field(
      [](const Eigen::Vector3d& x) { return Eigen::Vector3d(0.5 - x.y(), x.x() - 0.5, 0); }, grid);
  // A linear field is exact on the grid, so that the error is that in time: a quarter turn.
  std::array<double, 2> error{};
  for (int n = 0; n < 2; ++n) {
    LiquidParticles particles;
    particles.position = {{0.9F, 0.5F, 0.01F}};
    particles.velocity = {Eigen::Vector3f::Zero()};
    const int steps = n == 0 ? 3 : 6;
    for (int s = 0; s < steps; ++s) advect(grid, pi / 2 / steps, particles);
    error[n] =
        static_cast<double>((particles.position[0] - Eigen::Vector3f(0.5F, 0.9F, 0.01F)).norm());
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 3, 0.2);
}

TEST(LiquidAdvection, ZalesakDiscComesBackAfterATurn) {
  const MacGrid grid = flows::SlottedDisc::flow();
  LiquidParticles particles;
  for (int j = 0; j < 400; ++j) {
    for (int i = 0; i < 400; ++i) {
      const double x = (i + 0.5) / 4, y = (j + 0.5) / 4;
      if (!flows::SlottedDisc::contains(x, y)) continue;
      particles.position.push_back(Eigen::Vector3d(x, y, 1).cast<float>());
    }
  }
  particles.velocity.assign(particles.size(), Eigen::Vector3f::Zero());
  const std::vector<Eigen::Vector3f> start = particles.position;
  EXPECT_NEAR(static_cast<double>(particles.size()) / 16, flows::SlottedDisc::area(), 3);
  for (int s = 0; s < 628; ++s) advect(grid, 1, particles);
  // Round-off of 628 additions of numbers near 100: 628^(1/2) 4e-6, in a few directions.
  EXPECT_LT(furthest(particles.position, start), 2e-3F);
}

/// Volume within a closed surface whose vertices are particles.
double enclosed_volume(const std::vector<Eigen::Vector3f>& x, const Eigen::MatrixX3i& F) {
  double six = 0;
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const auto corner = [&](int c) -> Eigen::Vector3d {
      return x[F(f, c)].cast<double>() - Eigen::Vector3d::Constant(0.35);
    };
    six += corner(0).dot(corner(1).cross(corner(2)));
  }
  return six / 6;
}

/// What becomes of a sphere of radius 0.15 that Enright's flow tears into a sheet and puts back in
/// 3 s.
struct TornSphere {
  double volume_change = 0;  ///< largest on the way, relative
  double widest = 0;         ///< largest distance from the start on the way (m)
  double apart = 0;          ///< largest distance from the start at the end (m)
};
/// @param level  of the sphere's subdivision: its surface has 2 4^(level + 1) triangles
/// @param leak   divergence added to the flow (1/s)
TornSphere torn_sphere(int level, double leak = 0) {
  using flows::EnrightSphere;
  const MacGrid flow = EnrightSphere::flow(32, leak);
  const TriMesh sphere = shapes::sphere(level);
  LiquidParticles particles;
  for (Eigen::Index v = 0; v < sphere.V.rows(); ++v) {
    const Eigen::Vector3d x = 0.15 * sphere.V.row(v).transpose();
    particles.position.push_back((x + Eigen::Vector3d::Constant(0.35)).cast<float>());
  }
  particles.velocity.assign(particles.size(), Eigen::Vector3f::Zero());
  const std::vector<Eigen::Vector3f> start = particles.position;
  const double ball = enclosed_volume(start, sphere.F);
  EXPECT_NEAR(ball / (4 * pi / 3 * std::pow(0.15, 3)), 1, 1e-3);
  TornSphere result;
  for (int s = 0; s < EnrightSphere::kSteps; ++s) {
    EnrightSphere::step(flow, s, particles);
    result.apart = static_cast<double>(furthest(particles.position, start));
    result.widest = std::max(result.widest, result.apart);
    result.volume_change = std::max(
        result.volume_change, std::abs(enclosed_volume(particles.position, sphere.F) / ball - 1));
  }
  return result;
}

// The surface of the sphere is carried, so that the volume within is known on the way: what a flow
// without divergence keeps, and what a way back over the same errors does not show. The triangles
// cut the folds of the sheet short, by half as much squared when they are half as long; that is all
// there is.
TEST(LiquidAdvection, EnrightSphereKeepsItsVolumeOnTheWayAndComesBack) {
  const TornSphere coarse = torn_sphere(6), fine = torn_sphere(7);
  RecordProperty("change_of_volume_6", std::to_string(coarse.volume_change));
  RecordProperty("change_of_volume_7", std::to_string(fine.volume_change));
  EXPECT_GT(fine.widest, 0.3);  // it was far away
  EXPECT_NEAR(std::log2(coarse.volume_change / fine.volume_change), 2, 0.2);
  EXPECT_LT(fine.volume_change, 0.01);
  // The way back is the way there in the grid's own field; what is left is the error in time.
  EXPECT_LT(fine.apart, 0.02 / 32);
  // A flow that leaks comes back as well, and is seen on the way: exp(0.1 3 / pi) - 1.
  const TornSphere leaking = torn_sphere(6, 0.1);
  EXPECT_LT(leaking.apart, 0.02 / 32);
  EXPECT_NEAR(leaking.volume_change, std::exp(0.3 / pi) - 1, 0.03);
}

TEST(LiquidAdvection, ParticlesInASolidComeOutOnItsSurface) {
  const GridShape shape = grid_of({16, 16, 16}, 1.0 / 16);
  ScalarGrid distance({17, 17, 17}, 0);
  const Eigen::Vector3d centre(0.5, 0.5, 0.5);
  for (int k = 0; k < 17; ++k)
    for (int j = 0; j < 17; ++j)
      for (int i = 0; i < 17; ++i)
        distance(i, j, k) = static_cast<float>((shape.node(i, j, k) - centre).norm() - 0.3);
  LiquidParticles particles = tanks::scattered(2000, {0.01, 0.01, 0.01}, {0.99, 0.99, 0.99}, 2);
  const std::vector<Eigen::Vector3f> start = particles.position;
  std::vector<std::uint8_t> left;
  advect_particles(MacGrid(shape), 0.1, &distance, std::nullopt, particles, left);
  for (std::size_t p = 0; p < start.size(); ++p) {
    const double before = (start[p].cast<double>() - centre).norm();
    const double after = (particles.position[p].cast<double>() - centre).norm();
    if (before > 0.31) {
      EXPECT_EQ(particles.position[p], start[p]);
    }
    // Interpolation of a sphere of radius R errs by up to 3 h^2 / (8 R) = 5e-3.
    if (before > 0.2) {
      EXPECT_GT(after, 0.3 - 6e-3);
    }
  }
}

TEST(LiquidAdvection, ParticlesLeaveThroughTheOpenSideOnly) {
  const GridShape shape = grid_of({4, 4, 4}, 0.25);
  MacGrid grid(shape);
  for (ScalarGrid& face : grid.face) std::fill(face.values.begin(), face.values.end(), 1.0F);
  LiquidParticles particles;
  particles.position = {{0.9F, 0.9F, 0.9F}, {0.9F, 0.9F, 0.1F}};
  particles.velocity.assign(2, Eigen::Vector3f::Zero());
  std::vector<std::uint8_t> left;
  advect_particles(grid, 0.2, nullptr, OpenSide{2, true}, particles, left);
  EXPECT_EQ(left, (std::vector<std::uint8_t>{1, 0}));
  EXPECT_LT(particles.position[1].x(), 1);
  EXPECT_GT(particles.position[1].x(), 0.999F);
  EXPECT_NEAR(particles.position[1].z(), 0.3, 1e-6);
}

TEST(LiquidExtrapolation, ContinuesAConstantByTheLayersAskedFor) {
  MacGrid grid(grid_of({12, 3, 3}, 1));
  std::array<std::vector<char>, 3> known;
  for (std::size_t a = 0; a < 3; ++a) known[a].assign(grid.face[a].values.size(), 0);
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      grid.face[0](2, j, k) = 7;
      known[0][grid.face[0].index(2, j, k)] = 1;
    }
  }
  Extrapolator().extrapolate(4, grid, known);
  for (int i = 0; i <= 12; ++i) {
    const bool reached = std::abs(i - 2) <= 4;
    EXPECT_EQ(grid.face[0](i, 1, 1), reached ? 7 : 0) << i;
    EXPECT_EQ(known[0][grid.face[0].index(i, 1, 1)], reached ? 1 : 0) << i;
  }
}

TEST(LiquidExtrapolation, ClosedFacesOfASolidKeepItsNormalVelocityAndSlipAlong) {
  const GridShape shape = grid_of({8, 8, 8}, 1);
  MacGrid grid(shape);
  SolidFractions solids;
  solids.distance = ScalarGrid({9, 9, 9}, 0);
  const Eigen::Vector3d normal = Eigen::Vector3d(0, 1, 1).normalized();
  for (int k = 0; k < 9; ++k)
    for (int j = 0; j < 9; ++j)
      for (int i = 0; i < 9; ++i)
        solids.distance(i, j, k) = static_cast<float>(normal.dot(Eigen::Vector3d(i, j - 4, k - 4)));
  std::array<std::vector<char>, 3> known;
  const Eigen::Vector3f u(1, 2, -3), solid(0, 0.5F, 0);
  for (int a = 0; a < 3; ++a) {
    const std::size_t c = a;
    solids.open[c] = ScalarGrid(shape.face_cells(a), 0);
    solids.velocity[c] = ScalarGrid(shape.face_cells(a), solid[a]);
    grid.face[c] = ScalarGrid(shape.face_cells(a), u[a]);
    known[c].assign(grid.face[c].values.size(), 1);
  }
  constrain_to_solids(solids, known, grid);
  const Eigen::Vector3f n = normal.cast<float>();
  const Eigen::Vector3f expected = u - (u - solid).dot(n) * n;
  EXPECT_LT((velocity_at(grid, {4, 4, 4}).cast<float>() - expected).norm(), 1e-5F);
}

/// Distance that particles in boxes of half a cell, jittered, give for liquid up to a height.
ScalarGrid pool_distance(const GridShape& shape, double height) {
  Tank tank = tanks::tank_of(shape.cells, shape.cell);
  const double top = shape.cell * shape.cells.x();
  tank.volumes.push_back(tanks::at_rest(tanks::box_between({0, 0, 0}, {top, top, height})));
  const Liquid liquid(tank, LiquidOptions{}, 1);
  MacGrid grid(shape);
  std::array<std::vector<char>, 3> touched;
  ScalarGrid density, distance;
  ParticleToGrid(shape).gather(liquid.particles(), 8, grid, touched, density);
  liquid_distance(density, nullptr, shape, distance);
  return distance;
}

// The surface of a pool is where its particles end, whatever its height in the cell.
TEST(LiquidVolume, DistanceOfAPoolIsUnbiased) {
  const GridShape shape = grid_of({16, 16, 8}, 1.0 / 16);
  for (const double cells : {3.0, 3.25, 3.5, 3.75, 4.0}) {
    const double height = cells / 16;
    const ScalarGrid distance = pool_distance(shape, height);
    double mean = 0;
    int count = 0;
    for (int k = 0; k < 8; ++k) {
      const double exact = shape.cell_centre(0, 0, k).z() - height;
      if (std::abs(exact) > 0.6 * shape.cell) continue;
      for (int j = 0; j < 16; ++j)
        for (int i = 0; i < 16; ++i, ++count)
          mean += (static_cast<double>(distance(i, j, k)) - exact) / shape.cell;
    }
    EXPECT_NEAR(mean / count, 0, 0.05) << cells;
    EXPECT_NEAR(liquid_volume(distance, shape), height, 0.02 * height) << cells;
  }
}

TEST(LiquidVolume, AHoleBetweenParticlesIsNoBubble) {
  const GridShape shape = grid_of({5, 5, 5}, 1);
  ScalarGrid density({5, 5, 5}, 1.0F), distance;
  density(2, 2, 2) = 0.2F;
  liquid_distance(density, nullptr, shape, distance);
  EXPECT_LT(distance(2, 2, 2), 0);
}

TEST(LiquidVolume, CrowdedLiquidIsToExpandSparseOnlyInside) {
  const GridShape shape = grid_of({7, 7, 7}, 1);
  ScalarGrid density({7, 7, 7}, 1.0F), distance, target;
  for (int j = 0; j < 7; ++j)
    for (int i = 0; i < 7; ++i) {
      density(i, j, 6) = 0;
      density(i, j, 5) = 0.8F;
      density(i, j, 1) = i == 0 ? 1.2F : 0.9F;
    }
  liquid_distance(density, nullptr, shape, distance);
  density_target(density, nullptr, distance, 0.5, 0.06, target);
  EXPECT_NEAR(target(0, 3, 1), 0.06, 1e-6);   // bounded
  EXPECT_NEAR(target(3, 3, 1), -0.05, 1e-6);  // half of it
  EXPECT_EQ(target(3, 3, 5), 0);              // the surface, not a lack
  EXPECT_EQ(target(3, 3, 6), 0);
}

}  // namespace
}  // namespace geoprior::fluid
