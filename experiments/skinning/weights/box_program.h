#pragma once

#include <Eigen/SparseCore>

namespace geoprior::skinning {

/// Convex quadratic programs with the same matrix and the same bounds, one a column:
///
///   minimise  x^T Q x / 2 - c^T x  subject to  0 <= x <= 1
struct BoxProgram {
  Eigen::SparseMatrix<double> Q;  ///< n x n, symmetric positive definite
  Eigen::MatrixXd C;              ///< n x m
};

struct BoxSolution {
  Eigen::MatrixXd X;  ///< n x m, within the bounds
  int pivots = 0;     ///< changes of the active set: the most of any column
  /// Largest violation of the bounds and of the optimality conditions Qx - c >= 0 where x = 0, <= 0
  /// where x = 1, = 0 between, these over the diagonal of Q: in units of x.
  double residual = 0;
};

/// Block principal pivoting (Júdice and Pires 1994): unknowns are free or held at a bound; the free
/// ones are solved for, and all that then violate a bound or the sign of a multiplier change over.
/// The solution is exact to round-off, unknowns at the bounds exactly 0 and 1. Where ten such
/// changes in a row leave no fewer violations (they may go round in circles), only the larger ones
/// change over, and the solution is one whose violations are all below 1e-5.
///
/// Columns are solved in parallel, with the same bytes at any thread count.
///
/// @throws Error  when Q or a part of it has no factor, or a column needs more than `max_pivots`
BoxSolution solve_in_box(const BoxProgram& program, int max_pivots);

}  // namespace geoprior::skinning
