#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>
#include <vector>

namespace geoprior::sketch {

/// Sparse Cholesky factor of a symmetric positive definite matrix over the vertices of a mesh, kept
/// to solve for positions: x, y and z go through the factor in one pass.
class PositionCholesky {
 public:
  /// @param matrix  n x n; both triangles stored
  /// @param what    is solved, for the error
  /// @throws Error  when it is not positive definite
  PositionCholesky(const Eigen::SparseMatrix<double>& matrix, const std::string& what);

  /// Replaces right-hand sides (n x 3) by solutions.
  void solve(Eigen::MatrixX3d& values) const;

 private:
  std::vector<int> begin_;     ///< of the entries of each column of L below its diagonal
  std::vector<int> row_;       ///< of each entry
  std::vector<double> entry_;  ///< of L
  std::vector<double> pivot_;  ///< 1 / diagonal of L
  Eigen::VectorXi place_;      ///< of a vertex in the order of the factor
};

}  // namespace geoprior::sketch
