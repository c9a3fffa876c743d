#include <gtest/gtest.h>

#include <Eigen/IterativeLinearSolvers>

#include "core/parallel.h"
#include "core/random.h"
#include "tests/fluid/liquid/pressure_fixture.h"

namespace geoprior::fluid {
namespace {

using namespace pressure_test;

/// A sphere and a moving box in a tilted pool with waves: every kind of face occurs.
struct Pool {
  Tank tank;
  GridShape shape;
  SolidFractions solids;
  ScalarGrid distance;
  MacGrid velocity;

  explicit Pool(int n) {
    tank.cells = {n, n + 1, n - 1};
    tank.cell = 1.0 / n;
    tank.solids.resize(2);
    TankSolid& ball = tank.solids[0];
    ball.name = "ball";
    ball.shape.kind = LiquidShape::Kind::sphere;
    ball.shape.centre = {0.3, 0.35, 0.21};
    ball.shape.radius = 0.17;
    TankSolid& box = tank.solids[1];
    box.name = "box";
    box.motion = Trajectory{{{.time = 0, .shift = {0, 0, 0}}, {.time = 1, .shift = {0.4, 0.1, 0}}}};
    box.shape.centre = {0.7, 0.6, 0.3};
    box.shape.half_size = {0.08, 0.11, 0.3};
    shape = shape_of(tank);
    solids = fractions_of(tank, 0.3);
    distance = at_centres(shape, [](const Eigen::Vector3d& x) {
      return x.z() - 0.5 - 0.1 * x.x() + 0.03 * std::sin(9 * x.y());
    });
    velocity = MacGrid(shape);
    RandomStream random(7, "pool");
    for (ScalarGrid& face : velocity.face)
      for (float& u : face.values) u = static_cast<float>(0.2 * random.normal());
    push(velocity, tank.gravity, 0.01);
  }
};

struct Row {
  double diagonal = 0, right = 0;
  std::vector<Eigen::Triplet<double>> entries;
};

/// The discrete equation of a cell, written down from the solver's documentation for all cells of
/// the grid alike (unknowns are cell indices), without any of its code.
Row reference_row(const Pool& pool, const Eigen::Vector3i& c) {
  const GridShape& s = pool.shape;
  const auto me = static_cast<int>(s.index(c.x(), c.y(), c.z()));
  const double phi = pool.distance(c.x(), c.y(), c.z());
  Row row;
  for (int a = 0; a < 3; ++a)
    for (const int side : {-1, 1}) {
      Eigen::Vector3i face = c, next = c;
      if (side > 0) face[a] += 1;
      next[a] += side;
      const std::size_t axis = a;
      const double open = pool.solids.open[axis](face.x(), face.y(), face.z());
      row.right -= side * (open * pool.velocity.face[axis](face.x(), face.y(), face.z()) +
                           (1 - open) * pool.solids.velocity[axis](face.x(), face.y(), face.z()));
      if (open == 0) continue;
      if (next[a] < 0 || next[a] >= s.cells[a]) {
        row.diagonal += open / std::clamp(-phi / s.cell, 0.01, 0.5);
        continue;
      }
      const double other = pool.distance(next.x(), next.y(), next.z());
      const auto you = static_cast<int>(s.index(next.x(), next.y(), next.z()));
      if (other < 0) {
        row.diagonal += open;
        row.entries.emplace_back(me, you, -open);
      } else {
        row.diagonal += open / std::max(phi / (phi - other), 0.01);
      }
    }
  row.entries.emplace_back(me, me, row.diagonal);
  return row;
}

/// Pressure (Pa) of the assembled system by Eigen's conjugate gradients.
Eigen::VectorXd reference_pressure(const Pool& pool, double dt, double density) {
  const auto cells = static_cast<int>(pool.shape.cell_count());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(cells);
  for (int k = 0; k < pool.shape.cells.z(); ++k)
    for (int j = 0; j < pool.shape.cells.y(); ++j)
      for (int i = 0; i < pool.shape.cells.x(); ++i) {
        const auto me = static_cast<int>(pool.shape.index(i, j, k));
        const Row row = reference_row(pool, {i, j, k});
        if (pool.distance(i, j, k) < 0 && row.diagonal > 0) {
          entries.insert(entries.end(), row.entries.begin(), row.entries.end());
          right[me] = row.right;
        } else {
          entries.emplace_back(me, me, 1);
        }
      }
  Eigen::SparseMatrix<double> matrix(cells, cells);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper,
                           Eigen::IncompleteCholesky<double>>
      solver(matrix);
  solver.setTolerance(1e-12);
  return density * pool.shape.cell / dt * solver.solve(right);
}

class PressureSolverOf : public testing::TestWithParam<PressurePreconditioner> {};

INSTANTIATE_TEST_SUITE_P(Preconditioners, PressureSolverOf,
                         testing::Values(PressurePreconditioner::multigrid,
                                         PressurePreconditioner::incomplete_cholesky));

TEST_P(PressureSolverOf, AgreesWithEigenOnAnAssembledSystem) {
  Pool pool(20);
  PressureOptions options;
  options.preconditioner = GetParam();
  options.tolerance = 1e-10;
  const double dt = 0.01, density = 1000;
  const Eigen::VectorXd expected = reference_pressure(pool, dt, density);
  PressureSolver solver(pool.shape);
  std::array<std::vector<char>, 3> valid;
  const PressureReport report = solver.project(pool.solids, pool.distance, nullptr, dt, density,
                                               options, pool.velocity, valid);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.residual, 1e-10);
  double largest = 0;
  for (Eigen::Index c = 0; c < expected.size(); ++c)
    largest = std::max(largest, std::abs(expected[c] - solver.pressure().values[c]));
  // Coefficients and the pressure handed out are single precision: 6e-8 times a condition of 1e1.
  EXPECT_LE(largest, 2e-6 * expected.lpNorm<Eigen::Infinity>());
}

TEST_P(PressureSolverOf, LeavesNoDivergenceBeyondItsTolerance) {
  Pool pool(24);
  PressureOptions options;
  options.preconditioner = GetParam();
  PressureSolver solver(pool.shape);
  std::array<std::vector<char>, 3> valid;
  const PressureReport report = solver.project(pool.solids, pool.distance, nullptr, 0.01, 1000,
                                               options, pool.velocity, valid);
  double largest_right = 0;
  const Pool given(24);  // as it was before
  for (int k = 0; k < given.shape.cells.z(); ++k)
    for (int j = 0; j < given.shape.cells.y(); ++j)
      for (int i = 0; i < given.shape.cells.x(); ++i)
        if (given.distance(i, j, k) < 0)
          largest_right = std::max(largest_right, std::abs(reference_row(given, {i, j, k}).right));
  // The residual of the system is the outflow that stays (m/s); faces are stored in single
  // precision (6e-8 of speeds up to 1 m/s, twelve of them).
  EXPECT_LE(report.max_divergence * pool.shape.cell, 1e-5 * largest_right + 1e-6);
}

TEST_P(PressureSolverOf, GivesTheSameBitsForAnyNumberOfThreads) {
  std::array<std::vector<float>, 2> results;
  for (const int threads : {1, 2}) {
    Pool pool(40);
    PressureOptions options;
    options.preconditioner = GetParam();
    PressureSolver solver(pool.shape);
    std::array<std::vector<char>, 3> valid;
    with_threads(threads, [&] {
      solver.project(pool.solids, pool.distance, nullptr, 0.01, 1000, options, pool.velocity,
                     valid);
    });
    results[threads - 1] = pool.velocity.face[2].values;
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(PressureSolver, MultigridNeedsAboutTheSameIterationsOnFinerGrids) {
  // The V-cycle's point; incomplete Cholesky doubles with the grid (56 to 120 from 32^3 to 128^3).
  std::array<int, 2> iterations{};
  for (std::size_t l = 0; l < 2; ++l) {
    Pool pool(l == 0 ? 20 : 60);
    PressureSolver solver(pool.shape);
    std::array<std::vector<char>, 3> valid;
    iterations[l] =
        solver.project(pool.solids, pool.distance, nullptr, 0.01, 1000, {}, pool.velocity, valid)
            .iterations;
  }
  EXPECT_LE(iterations[1], iterations[0] + 5);
  EXPECT_LE(iterations[1], 20);
}

TEST(PressureSolver, SaysWhenItRunsOutOfIterations) {
  Pool pool(20);
  PressureOptions options;
  options.max_iterations = 2;
  PressureSolver solver(pool.shape);
  std::array<std::vector<char>, 3> valid;
  const PressureReport report = solver.project(pool.solids, pool.distance, nullptr, 0.01, 1000,
                                               options, pool.velocity, valid);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 2);
  EXPECT_GT(report.residual, options.tolerance);
}

TEST(PressureSolver, ReachesTheDivergenceAskedFor) {
  Pool pool(20);
  const ScalarGrid target =
      at_centres(pool.shape, [](const Eigen::Vector3d& x) { return x.x() < 0.5 ? 3.0 : -1.0; });
  PressureSolver solver(pool.shape);
  std::array<std::vector<char>, 3> valid;
  solver.project(pool.solids, pool.distance, &target, 0.01, 1000, {.tolerance = 1e-8},
                 pool.velocity, valid);
  // A cell far from solids and surface: the sum of its six faces over h.
  const auto& [u, v, w] = pool.velocity.face;
  const int i = 3, j = 15, k = 5;
  const double divergence = static_cast<double>(u(i + 1, j, k) - u(i, j, k) + v(i, j + 1, k) -
                                                v(i, j, k) + w(i, j, k + 1) - w(i, j, k)) /
                            pool.shape.cell;
  EXPECT_NEAR(divergence, 3, 1e-4);
}

}  // namespace
}  // namespace geoprior::fluid
