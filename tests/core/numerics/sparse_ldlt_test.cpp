#include "core/numerics/sparse_ldlt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace geoprior {
namespace {

using Matrix = SparseLdlt::Matrix;

/// Second differences of n values between zeros: eigenvalues 2 - 2 cos(k pi / (n + 1)).
Matrix second_differences(int n) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 2.0);
    if (i > 0) entries.emplace_back(i, i - 1, -1.0);
  }
  Matrix A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

// The load 1 gives i (n + 1 - i) / 2, the parabola, exactly at the nodes.
TEST(SparseLdlt, SolvesASecondDifference) {
  constexpr int n = 20;
  const SparseLdlt factor(second_differences(n));
  ASSERT_TRUE(factor.succeeded());
  const Eigen::VectorXd x = factor.solve(Eigen::VectorXd::Ones(n));
  for (int i = 1; i <= n; ++i) EXPECT_NEAR(x(i - 1), i * (n + 1 - i) / 2.0, 1e-12 * n * n);
}

TEST(SparseLdlt, ColumnsAreSolvedAsVectorsAre) {
  const SparseLdlt factor(second_differences(9));
  const Eigen::MatrixX3d B = Eigen::MatrixX3d::Random(9, 3);
  const Eigen::MatrixXd X = factor.solve_columns(B);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(X.col(c), factor.solve(B.col(c)));
}

TEST(SparseLdlt, PivotsCountTheEigenvaluesBelowAShift) {
  constexpr int n = 12;
  const Matrix A = second_differences(n);
  SparseLdlt factor;
  factor.analyze(A);
  for (const int below : {0, 1, 5, n}) {
    const auto eigenvalue = [](int k) { return 2 - 2 * std::cos(k * std::numbers::pi / (n + 1)); };
    factor.factorize(A, -(eigenvalue(below) + eigenvalue(below + 1)) / 2);
    ASSERT_TRUE(factor.succeeded());
    EXPECT_EQ((factor.pivots().array() < 0).count(), below);
  }
}

TEST(SparseLdlt, FailsOnAZeroPivotAndWorksAgainAfterIt) {
  SparseLdlt factor(second_differences(4));
  factor.factorize(Matrix(4, 4));
  EXPECT_FALSE(factor.succeeded());
  factor.factorize(second_differences(4));
  EXPECT_TRUE(factor.succeeded());
  const SparseLdlt moved = std::move(factor);
  EXPECT_TRUE(moved.succeeded());
}

}  // namespace
}  // namespace geoprior
