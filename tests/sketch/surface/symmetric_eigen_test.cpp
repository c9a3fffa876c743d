#include "baselines/sketch/shared/symmetric_eigen.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "core/random.h"

namespace geoprior::sketch {
namespace {

/// Q diag(values) Q' with a rotation drawn at random.
Eigen::Matrix3d with_eigenvalues(const Eigen::Vector3d& values, RandomStream& random) {
  const Eigen::Matrix3d q =
      Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
          .normalized()
          .toRotationMatrix();
  const Eigen::Matrix3d matrix = q * values.asDiagonal() * q.transpose();
  return (matrix + matrix.transpose()) / 2;
}

void expect_decomposes(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& values) {
  const double scale = std::max(matrix.cwiseAbs().maxCoeff(), 1e-300);
  const SymmetricEigen found = symmetric_eigen(matrix);
  EXPECT_LT((found.values - values).cwiseAbs().maxCoeff(), 1e-14 * scale) << matrix;
  const Eigen::Matrix3d rebuilt =
      found.vectors * found.values.asDiagonal() * found.vectors.transpose();
  EXPECT_LT((rebuilt - matrix).cwiseAbs().maxCoeff(), 1e-14 * scale) << matrix;
  EXPECT_NEAR(found.vectors.determinant(), 1, 1e-14) << matrix;
  const Eigen::Vector3d smallest = smallest_eigenvector(matrix);
  EXPECT_NEAR(smallest.norm(), 1, 1e-14);
  EXPECT_LT((matrix * smallest - values(0) * smallest).norm(), 1e-14 * scale) << matrix;
}

TEST(SymmetricEigen, RebuildsMatricesOfKnownEigenvalues) {
  RandomStream random(3, "eigenvalues");
  const std::vector<Eigen::Vector3d> spectra{
      {1, 2, 3},         {-3, 1, 1.5},     {-2, -1, 7},           {0, 0, 1},
      {0, 1, 1},         {1, 1, 1},        {0, 1e-9, 1},          {0, 1, 1.0 + 1e-9},
      {1, 1, 1 + 1e-13}, {1e-12, 1e-6, 1}, {1e150, 2e150, 5e150}, {1e-150, 3e-150, 4e-150}};
  for (const Eigen::Vector3d& values : spectra)
    for (int i = 0; i < 100; ++i) expect_decomposes(with_eigenvalues(values, random), values);
}

TEST(SymmetricEigen, TakesDiagonalAndZeroMatrices) {
  expect_decomposes(Eigen::Vector3d(3, 1, 2).asDiagonal(), {1, 2, 3});
  expect_decomposes(Eigen::Vector3d(2, 2, 1).asDiagonal(), {1, 2, 2});
  expect_decomposes(Eigen::Matrix3d::Zero(), {0, 0, 0});
  expect_decomposes(4 * Eigen::Matrix3d::Identity(), {4, 4, 4});
}

TEST(SymmetricEigen, AgreesWithAnIterationOnCovariancesOfNearlyCoplanarNormals) {
  // What the flows ask for: unit normals near a great circle, down to a plane exactly.
  RandomStream random(5, "normals");
  for (const double off : {0.3, 1e-3, 1e-8, 0.0}) {
    for (int i = 0; i < 100; ++i) {
      Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
      for (int k = 0; k < 6; ++k) {
        const double angle = 0.4 * random.uniform();
        const Eigen::Vector3d n =
            Eigen::Vector3d(std::cos(angle), std::sin(angle), off * random.normal()).normalized();
        sum += n * n.transpose();
      }
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> iterated(sum);
      const SymmetricEigen closed = symmetric_eigen(sum);
      EXPECT_LT((closed.values - iterated.eigenvalues()).cwiseAbs().maxCoeff(), 1e-14);
      if (iterated.eigenvalues()(1) > 1e-3) {
        EXPECT_GT(std::abs(closed.vectors.col(0).dot(iterated.eigenvectors().col(0))), 1 - 1e-14);
      }
    }
  }
}

}  // namespace
}  // namespace geoprior::sketch
