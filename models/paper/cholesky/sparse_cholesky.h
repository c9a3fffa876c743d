#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "models/paper/cholesky/block_matrix.h"

namespace geoprior::paper {

/// Elimination orders of a node graph: minimum degree, or METIS' nested dissection.
enum class Ordering { minimum_degree, nested_dissection };
/// Position of each node in the order. Postordered: a node's place in the elimination tree is near
/// its children's, so that columns of like structure are neighbours (supernodes).
std::vector<int> elimination_order(const NodeGraph& graph, Ordering ordering);

/// Factorisation of a symmetric positive definite block matrix whose rows are already in
/// elimination order. Analysed once a pattern, factorised often.
class SparseCholesky {
 public:
  virtual ~SparseCholesky() = default;
  /// False when the matrix is not positive definite or not finite.
  [[nodiscard]] virtual bool factorise(const BlockMatrix& matrix) = 0;
  /// Overwrites the right-hand side with the solution.
  virtual void solve(Eigen::VectorXd& b) = 0;
  [[nodiscard]] virtual long nonzeros() const = 0;
};

}  // namespace geoprior::paper
