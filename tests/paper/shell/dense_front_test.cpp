#include "models/paper/cholesky/dense_front.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <utility>

#include "core/random.h"

namespace geoprior::paper {
namespace {

/// A front in the memory that the kernels ask for: rows padded, columns `stride` apart.
struct Front {
  Front(int rows, int columns)
      : stride(front_stride(rows)), values(Eigen::VectorXd::Zero(stride * columns + 16)) {}
  [[nodiscard]] auto matrix(int rows, int columns) {
    return Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>(values.data(), rows, columns,
                                                                Eigen::OuterStride<>(stride));
  }
  int stride;
  Eigen::VectorXd values;
};

Eigen::MatrixXd random_matrix(int rows, int columns) {
  RandomStream random(7, "matrix");
  Eigen::MatrixXd M(rows, columns);
  for (Eigen::Index i = 0; i < M.size(); ++i) M.data()[i] = random.normal();
  return M;
}

/// Lower triangle of a positive definite matrix, its first `width` columns.
Front front_of(const Eigen::MatrixXd& A, int width) {
  Front front(static_cast<int>(A.rows()), width);
  front.matrix(static_cast<int>(A.rows()), width) = A.leftCols(width);
  return front;
}

Eigen::MatrixXd positive_definite(int size) {
  const Eigen::MatrixXd M = random_matrix(size, size);
  return M * M.transpose() + size * Eigen::MatrixXd::Identity(size, size);
}

/// The textbook's factor, a column at a time: L_jj = sqrt(A_jj - sum_k L_jk^2),
/// L_ij = (A_ij - sum_k L_ik L_jk) / L_jj.
Eigen::MatrixXd factor_by_columns(const Eigen::MatrixXd& A, int width) {
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(A.rows(), width);
  for (int j = 0; j < width; ++j) {
    for (Eigen::Index i = j; i < A.rows(); ++i)
      L(i, j) = A(i, j) - L.row(i).head(j).dot(L.row(j).head(j));
    L.col(j).tail(A.rows() - j) /= std::sqrt(L(j, j));
  }
  return L;
}

// Sizes below, at and beyond a panel of 48 columns and tiles of 4, 8 and 16 rows.
TEST(DenseFront, FactorisesAsTheTextbookDoes) {
  for (const auto& [height, width] :
       {std::pair{3, 3}, {9, 6}, {21, 12}, {48, 48}, {60, 51}, {201, 99}}) {
    const Eigen::MatrixXd A = positive_definite(height);
    Front front = front_of(A, width);
    ASSERT_TRUE(factorise_front(front.values.data(), front.stride, height, width));
    const Eigen::MatrixXd expected = factor_by_columns(A, width);
    for (int j = 0; j < width; ++j) {
      const auto below = front.matrix(height, width).col(j).tail(height - j);
      EXPECT_LT((below - expected.col(j).tail(height - j)).norm(), 1e-12 * expected.norm())
          << height << " " << width << " " << j;
    }
  }
}

TEST(DenseFront, SubtractsTheOuterProductFromTheLowerTriangle) {
  for (const auto& [size, depth] : {std::pair{3, 3}, {21, 50}, {90, 99}, {240, 60}}) {
    const Eigen::MatrixXd C = positive_definite(size), B = random_matrix(size, depth);
    Front c = front_of(C, size), b = front_of(B, depth);
    subtract_outer_product(c.values.data(), c.stride, b.values.data(), b.stride, size, depth);
    const Eigen::MatrixXd expected = C - B * B.transpose();
    const Eigen::MatrixXd difference = c.matrix(size, size) - expected;
    EXPECT_LT(Eigen::MatrixXd(difference.triangularView<Eigen::Lower>()).norm(),
              1e-12 * expected.norm());
  }
}

TEST(DenseFront, SolvesWithBothBlocksOfTheFactor) {
  const int height = 50, width = 27;
  const Eigen::MatrixXd A = positive_definite(height);
  Front front = front_of(A, width);
  ASSERT_TRUE(factorise_front(front.values.data(), front.stride, height, width));
  const Eigen::MatrixXd L = factor_by_columns(A, width);
  const auto L11 = L.topRows(width).triangularView<Eigen::Lower>();
  const auto L21 = L.bottomRows(height - width);
  const Eigen::VectorXd b = random_matrix(height, 1);
  Eigen::VectorXd x = b.head(width), y = b.tail(height - width);
  solve_front(front.values.data(), front.stride, height, width, x.data(), y.data());
  const Eigen::VectorXd expected = L11.solve(b.head(width));
  EXPECT_LT((x - expected).norm(), 1e-12 * expected.norm());
  EXPECT_LT((y - (b.tail(height - width) - L21 * expected)).norm(), 1e-12 * b.norm());
  solve_front_transposed(front.values.data(), front.stride, height, width, x.data(), y.data());
  const Eigen::VectorXd back =
      L11.transpose().solve(Eigen::VectorXd(expected - L21.transpose() * y));
  EXPECT_LT((x - back).norm(), 1e-12 * back.norm());
}

}  // namespace
}  // namespace geoprior::paper
