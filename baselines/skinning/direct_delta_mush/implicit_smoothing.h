#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "core/mesh.h"

namespace geoprior::skinning {

/// Implicit Laplacian smoothing X <- (I + length D^-1 L)^-steps X of values on a mesh, L the
/// cotangent Laplacian with positive edge weights and D its diagonal.
///
/// Constants stay, and every result lies between the values. (D + length L) X' = D X is solved by
/// one sparse Cholesky factorisation. Values are solved for a dozen columns at a time (one pass
/// through the factor for all of them) by the calling thread; `apply` may run in several threads at
/// once.
class ImplicitSmoothing {
 public:
  /// @param mesh  any triangle mesh of n vertices; one without triangles keeps its value
  ImplicitSmoothing(const TriMesh& mesh, double length, int steps);
  /// The same with D = diag(mass), positive: (D + length L) X' = D X.
  ImplicitSmoothing(const TriMesh& mesh, const Eigen::VectorXd& mass, double length, int steps);

  /// Smooths the columns of `values` (n x any number).
  void apply(Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>& values) const;

 private:
  /// @param laplacian  L, its whole diagonal stored
  /// @param mass       empty: that diagonal
  ImplicitSmoothing(const Eigen::SparseMatrix<double>& laplacian, const Eigen::VectorXd& mass,
                    double length, int steps);
  void solve(double* rows) const;

  int steps_;
  Eigen::SparseMatrix<double> factor_;  ///< lower triangle, each column begins with its diagonal
  Eigen::VectorXi place_;               ///< of a vertex in the order of the factor
  Eigen::VectorXd diagonal_;            ///< D, in that order
};

}  // namespace geoprior::skinning
