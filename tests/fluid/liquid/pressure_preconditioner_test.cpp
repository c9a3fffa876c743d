#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "baselines/fluid/liquid/pressure/incomplete_cholesky.h"
#include "baselines/fluid/liquid/pressure/multigrid.h"
#include "baselines/fluid/liquid/pressure/system.h"
#include "core/random.h"

namespace geoprior::fluid {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

Eigen::Vector3i place(const PressureSystem& system, int c) {
  const int at = system.cell[c], nx = system.size.x(), ny = system.size.y();
  return {at % nx, at / nx % ny, at / (nx * ny)};
}

/// A blob of unknowns in a box, links of 0.2 to 1 between neighbours, and open faces at its border.
PressureSystem blob(const Eigen::Vector3i& size) {
  RandomStream random(5, "links");
  std::vector<std::uint8_t> marked(size.prod());
  for (std::uint8_t& mark : marked) mark = random.uniform() < 0.9 ? 1 : 0;
  PressureSystem system;
  system.number_cells(size, marked);
  system.resize_coefficients();
  const auto couple = [&](int axis, int c, int next) {
    const auto link = static_cast<float>(0.2 + 0.8 * random.uniform());
    if (next != 0) {
      system.link[axis][c] = link;
      system.diagonal[next] += link;
    }
    system.diagonal[c] += link;  // a face without a neighbour opens to the air
  };
  for (int c = 1; c <= system.n; ++c) {
    const bool row_goes_on =
        place(system, c).x() + 1 < size.x() && system.number[system.cell[c] + 1] != 0;
    couple(0, c, row_goes_on ? c + 1 : 0);
    couple(1, c, system.upper[0][c]);
    couple(2, c, system.upper[1][c]);
  }
  return system;
}

/// The system with unknown c in row c - 1.
Matrix matrix_of(const PressureSystem& system) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int c = 1; c <= system.n; ++c) {
    entries.emplace_back(c - 1, c - 1, system.diagonal[c]);
    const std::array<int, 3> upper{c + 1, system.upper[0][c], system.upper[1][c]};
    for (int a = 0; a < 3; ++a) {
      if (system.link[a][c] == 0) continue;
      entries.emplace_back(c - 1, upper[a] - 1, -system.link[a][c]);
      entries.emplace_back(upper[a] - 1, c - 1, -system.link[a][c]);
    }
  }
  Matrix matrix(system.n, system.n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::VectorXd applied(PressureApproximation& approximation, const PressureSystem& system,
                        const Eigen::VectorXd& r) {
  std::vector<double> in(static_cast<std::size_t>(system.n) + 2, 0), out(in);
  for (int c = 1; c <= system.n; ++c) in[c] = r[c - 1];
  approximation.build(system);
  approximation.apply(in, out);
  return Eigen::Map<const Eigen::VectorXd>(out.data() + 1, system.n);
}

Eigen::VectorXd random_vector(Eigen::Index n) {
  RandomStream random(6, "right-hand side");
  Eigen::VectorXd r(n);
  for (double& value : r) value = random.normal();
  return r;
}

/// One level of the V-cycle as the header describes it, by its grid cells and its matrix.
struct Level {
  Matrix A;
  std::vector<Eigen::Vector3i> cell;

  /// Gauss–Seidel on the unknowns of one parity of i + j + k.
  void relax(int parity, const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
    for (int c = 0; c < A.rows(); ++c)
      if (cell[c].sum() % 2 == parity) x[c] += (b[c] - A.row(c).dot(x)) / A.coeff(c, c);
  }
};

/// P takes a coarse unknown to the fine ones in its 2 x 2 x 2 cells; the coarse matrix is P' A P
/// / 2.
Level coarsened(const Level& fine, Matrix& P) {
  Level coarse;
  std::vector<Eigen::Triplet<double>> entries;
  for (int c = 0; c < fine.A.rows(); ++c) {
    const Eigen::Vector3i at = fine.cell[c] / 2;
    const auto found = std::find(coarse.cell.begin(), coarse.cell.end(), at);
    entries.emplace_back(c, static_cast<int>(found - coarse.cell.begin()), 1);
    if (found == coarse.cell.end()) coarse.cell.push_back(at);
  }
  P.resize(fine.A.rows(), coarse.cell.size());
  P.setFromTriplets(entries.begin(), entries.end());
  coarse.A = 0.5 * (P.transpose() * fine.A * P);
  return coarse;
}

/// Even and odd before, odd and even after; twelve of either on the coarsest level.
Eigen::VectorXd v_cycle(const Level& level, const Eigen::VectorXd& b) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  const bool coarsest = level.A.rows() <= 60;
  for (int sweep = 0; sweep < (coarsest ? 12 : 1); ++sweep)
    for (const int parity : {0, 1}) level.relax(parity, b, x);
  if (!coarsest) {
    Matrix P;
    const Level coarse = coarsened(level, P);
    x += P * v_cycle(coarse, P.transpose() * (b - level.A * x));
  }
  for (int sweep = 0; sweep < (coarsest ? 12 : 1); ++sweep)
    for (const int parity : {1, 0}) level.relax(parity, b, x);
  return x;
}

TEST(PressureMultigrid, IsTheVCycleOfGalerkinMatricesOverAggregates) {
  const PressureSystem system = blob({11, 10, 9});  // about 900 unknowns, then 150, then 27
  Level finest{matrix_of(system), {}};
  for (int c = 1; c <= system.n; ++c) finest.cell.push_back(place(system, c));
  const Eigen::VectorXd r = random_vector(system.n);
  const auto multigrid = make_multigrid_approximation();
  const Eigen::VectorXd expected = v_cycle(finest, r);
  // Single precision.
  EXPECT_LT((applied(*multigrid, system, r) - expected).norm(), 1e-5 * expected.norm());
}

/// Modified incomplete Cholesky of level 0 (Bridson 2015, section 5.3): L keeps the pattern of A
/// within slabs of n / 8 unknowns, and 0.97 of the fill that this drops goes to the diagonal.
Eigen::MatrixXd incomplete_factor(const Eigen::MatrixXd& A) {
  const Eigen::Index n = A.rows(), slab = (n + 7) / 8;
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index c = 0; c < n; ++c) {
    double pivot = A(c, c);
    for (Eigen::Index j = c / slab * slab; j < c; ++j) {
      if (A(c, j) == 0) continue;
      L(c, j) = A(c, j) / L(j, j);
      double fill = 0;  // of row c in the columns right of j that column j reaches besides c
      for (Eigen::Index k = j + 1; k < n; ++k)
        if (k != c) fill += A(c, j) * A(j, k) / (L(j, j) * L(j, j));
      pivot -= L(c, j) * L(c, j) + 0.97 * fill;
    }
    L(c, c) = std::sqrt(pivot < 0.25 * A(c, c) ? A(c, c) : pivot);
  }
  return L;
}

TEST(PressureIncompleteCholesky, IsTheModifiedFactorWithinSlabs) {
  const PressureSystem system = blob({8, 7, 6});
  const Eigen::MatrixXd A = matrix_of(system), L = incomplete_factor(A);
  const Eigen::VectorXd r = random_vector(system.n);
  const auto cholesky = make_incomplete_cholesky_approximation();
  const Eigen::VectorXd expected = (L * L.transpose()).ldlt().solve(r);
  // Single precision.
  EXPECT_LT((applied(*cholesky, system, r) - expected).norm(), 1e-5 * expected.norm());
}

}  // namespace
}  // namespace geoprior::fluid
