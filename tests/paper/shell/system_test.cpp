#include "models/paper/shell/system.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "models/paper/cholesky/cholmod.h"
#include "models/paper/cholesky/eigen.h"
#include "models/paper/cholesky/sparse_cholesky.h"
#include "models/paper/cholesky/supernodal.h"
#include "tests/paper/sheets.h"

namespace geoprior::paper {
namespace {

using Triangle = BlockMatrix::Triangle;

/// A random sheet, crumpled by a millimetre, and its system.
struct System {
  explicit System(int triangles, Triangle triangle, Ordering ordering = Ordering::minimum_degree) {
    const Sheet sheet = sheets::free_sheet(0.3, 0.2);
    state = sheets::at_rest(sheet, triangles, UniformLayout::delaunay);
    RandomStream random(7, "crumple");
    for (Eigen::Index i = 0; i < state.x.size(); ++i) {
      state.x.data()[i] += 1e-3 * (random.uniform() - 0.5);
    }
    elements.emplace(state.mesh, sheet.material, BendingLaw());
    std::vector<int> offset(1, 0), members;
    for (int e = 0; e < elements->size(); ++e) {
      const auto nodes = elements->nodes(e);
      members.insert(members.end(), nodes.begin(), nodes.end());
      offset.push_back(static_cast<int>(members.size()));
    }
    graph = couple_groups(state.mesh.vertex_count(), offset, members);
    position = elimination_order(graph, ordering);
    matrix = BlockMatrix(graph, position, triangle);
    system.emplace(*elements, position, matrix);
  }
  /// M + dt^2 K with unit masses of 1e-4 kg: positive definite.
  void fill() {
    matrix.set_zero();
    system->hessian(*elements, state, state.x, 2.5e-5, sums, matrix);
    for (int i = 0; i < matrix.nodes(); ++i) matrix.add_to_diagonal(i, 1e-4);
  }
  [[nodiscard]] Eigen::MatrixXd dense() const {
    const Eigen::MatrixXd half = matrix.sparse();
    Eigen::MatrixXd full(half.rows(), half.cols());
    if (matrix.triangle() == Triangle::upper) {
      full = half.selfadjointView<Eigen::Upper>();
    } else {
      full = half.selfadjointView<Eigen::Lower>();
    }
    return full;
  }
  [[nodiscard]] Eigen::VectorXd random_vector() const {
    RandomStream random(3, "right-hand side");
    Eigen::VectorXd b(3 * matrix.nodes());
    for (Eigen::Index i = 0; i < b.size(); ++i) b[i] = random.normal();
    return b;
  }

  ShellState state;
  std::optional<ShellElements> elements;
  NodeGraph graph;
  std::vector<int> position;
  BlockMatrix matrix;
  std::optional<ShellSystem> system;
  ShellSystem::Sums sums;
};

TEST(ShellSystem, GradientIsTheDerivativeOfTheEnergy) {
  System s(80, Triangle::upper);
  s.system->gradient(*s.elements, s.state, s.state.x, s.sums);
  const Eigen::VectorXd gradient = s.sums.gradient;
  RandomStream random(5, "direction");
  for (int k = 0; k < 5; ++k) {
    Eigen::MatrixX3d direction(s.state.x.rows(), 3);
    double slope = 0;
    for (Eigen::Index i = 0; i < direction.rows(); ++i) {
      direction.row(i) << random.normal(), random.normal(), random.normal();
      slope += gradient.segment<3>(3 * s.position[i]).dot(direction.row(i));
    }
    // Central differences, error h^2: at 1e-7 m both truncation and round-off are below 1e-6.
    const double h = 1e-7;
    ShellSystem::Sums before, after;
    s.system->energy(*s.elements, s.state, s.state.x - h * direction, before);
    s.system->energy(*s.elements, s.state, s.state.x + h * direction, after);
    const double difference =
        (after.membrane + after.bending - before.membrane - before.bending) / (2 * h);
    EXPECT_NEAR(difference, slope, 1e-6 * gradient.norm() * direction.norm());
  }
}

/// The offsets put every element's block where a sum in plain loops puts it.
TEST(ShellSystem, ScattersTheElementsHessians) {
  for (const Triangle triangle : {Triangle::upper, Triangle::lower}) {
    System s(120, triangle);
    s.matrix.set_zero();
    s.system->hessian(*s.elements, s.state, s.state.x, 2.0, s.sums, s.matrix);
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3 * s.matrix.nodes(), 3 * s.matrix.nodes());
    ShellElements::Local local;
    for (int e = 0; e < s.elements->size(); ++e) {
      s.elements->evaluate(e, s.state, s.state.x, ShellElements::Order::hessian, local);
      const auto nodes = s.elements->nodes(e);
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        for (std::size_t b = 0; b < nodes.size(); ++b) {
          expected.block<3, 3>(3 * s.position[nodes[a]], 3 * s.position[nodes[b]]) +=
              2 * local.hessian.block<3, 3>(3 * a, 3 * b);
        }
      }
    }
    EXPECT_LT((s.dense() - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST(ShellSystem, SumsTheSameBitsOnOneAndTwoThreads) {
  System s(900, Triangle::lower);
  const auto sum = [&](int threads) {
    with_threads(threads, [&] { s.fill(); });
    std::vector<double> bits(s.matrix.values(), s.matrix.values() + s.matrix.sparse().nonZeros());
    bits.insert(bits.end(), s.sums.gradient.begin(), s.sums.gradient.end());
    bits.push_back(s.sums.membrane);
    bits.push_back(s.sums.bending);
    return bits;
  };
  const std::vector<double> one = sum(1);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(one, sum(2));
}

TEST(BlockMatrix, MultipliesAsTheFullMatrix) {
  for (const Triangle triangle : {Triangle::upper, Triangle::lower}) {
    System s(60, triangle);
    s.fill();
    const Eigen::VectorXd x = s.random_vector();
    Eigen::VectorXd y;
    s.matrix.multiply(x, y);
    const Eigen::VectorXd expected = s.dense() * x;
    EXPECT_LT((y - expected).norm(), 1e-13 * expected.norm());
  }
}

/// A = A' with held rows and columns those of the unit matrix, and what was taken out.
TEST(BlockMatrix, TakesOutHeldRowsWithoutLosingThem) {
  for (const Triangle triangle : {Triangle::upper, Triangle::lower}) {
    System s(60, triangle);
    s.fill();
    const Eigen::MatrixXd before = s.dense();
    std::vector<char> held(s.matrix.nodes(), 0);
    held[0] = held[5] = held.back() = 1;
    std::vector<BlockMatrix::Taken> taken;
    s.matrix.take_out(held, taken);
    const Eigen::MatrixXd after = s.dense();
    for (Eigen::Index i = 0; i < after.rows(); ++i) {
      for (Eigen::Index j = 0; j < after.cols(); ++j) {
        const bool out = held[i / 3] != 0 || held[j / 3] != 0;
        ASSERT_EQ(after(i, j), out ? static_cast<double>(i == j) : before(i, j));
      }
    }
    const Eigen::VectorXd x = s.random_vector();
    Eigen::VectorXd y;
    s.matrix.multiply(x, y);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (held[i / 3] != 0) y[i] -= x[i];
    }
    multiply_taken(taken, x, y);
    EXPECT_LT((y - before * x).norm(), 1e-13 * before.norm() * x.norm());
  }
}

TEST(BlockMatrix, RefusesABlockOutsideItsPattern) {
  const System s(200, Triangle::upper);
  int far = 0;
  const auto near = s.graph.neighbours(0);
  while (far == 0 || std::find(near.begin(), near.end(), far) != near.end()) ++far;
  EXPECT_THROW(static_cast<void>(s.matrix.place(s.position[0], s.position[far])), Error);
}

TEST(EliminationOrder, IsAPermutation) {
  for (const Ordering ordering : {Ordering::minimum_degree, Ordering::nested_dissection}) {
    const System s(300, Triangle::upper, ordering);
    std::vector<int> sorted = s.position;
    std::sort(sorted.begin(), sorted.end());
    std::vector<int> expected(sorted.size());
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(sorted, expected);
  }
}

struct Solver {
  Triangle triangle;
  std::unique_ptr<SparseCholesky> (*make)(const BlockMatrix&);
};
constexpr std::array<Solver, 3> kSolvers{{{Triangle::upper, make_eigen_cholesky},
                                          {Triangle::lower, make_cholmod_cholesky},
                                          {Triangle::lower, make_supernodal_cholesky}}};

TEST(SparseCholesky, EverySolverAgreesWithTheDenseSolution) {
  for (const Solver& solver : kSolvers) {
    // 2 triangles: one front; 60 and 300: one tree; 900: subtrees in parallel.
    for (const int triangles : {2, 60, 300, 900}) {
      for (const Ordering ordering : {Ordering::minimum_degree, Ordering::nested_dissection}) {
        System s(triangles, solver.triangle, ordering);
        s.fill();
        const auto cholesky = solver.make(s.matrix);
        ASSERT_TRUE(cholesky->factorise(s.matrix));
        const Eigen::VectorXd b = s.random_vector();
        Eigen::VectorXd x = b, product;
        cholesky->solve(x);
        if (triangles <= 300) {
          const Eigen::VectorXd expected = s.dense().ldlt().solve(b);
          EXPECT_LT((x - expected).norm(), 1e-10 * expected.norm());
        }
        s.matrix.multiply(x, product);
        EXPECT_LT((product - b).norm(), 1e-10 * b.norm());
      }
    }
  }
}

TEST(SparseCholesky, SupernodalSolvesTheSameBitsOnOneAndTwoThreads) {
  System s(1500, Triangle::lower, Ordering::nested_dissection);
  s.fill();
  const auto cholesky = make_supernodal_cholesky(s.matrix);
  const auto solve = [&](int threads) {
    Eigen::VectorXd x = s.random_vector();
    with_threads(threads, [&] {
      ASSERT_TRUE(cholesky->factorise(s.matrix));
      cholesky->solve(x);
    });
    return x;
  };
  const Eigen::VectorXd one = solve(1);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(one, solve(2));
}

TEST(SparseCholesky, RefusesIndefiniteAndNotFinite) {
  for (const Solver& solver : kSolvers) {
    System s(60, solver.triangle);
    const auto cholesky = solver.make(s.matrix);
    for (const double wrong : {-1e9, std::numeric_limits<double>::quiet_NaN()}) {
      s.fill();
      s.matrix.add_to_diagonal(3, wrong);
      EXPECT_FALSE(cholesky->factorise(s.matrix));
    }
    s.fill();
    EXPECT_TRUE(cholesky->factorise(s.matrix));
  }
}

}  // namespace
}  // namespace geoprior::paper
