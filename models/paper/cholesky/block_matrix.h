#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

namespace geoprior::paper {

/// Which nodes share an element: compressed neighbour lists, both directions, no node with itself.
struct NodeGraph {
  std::vector<int> offset;  ///< n + 1
  std::vector<int> items;
  [[nodiscard]] int nodes() const { return static_cast<int>(offset.size()) - 1; }
  [[nodiscard]] std::span<const int> neighbours(int node) const;
};

/// Graph in which the nodes of every group are coupled with each other.
/// @param offset  of each group in `members` (groups + 1)
NodeGraph couple_groups(int nodes, std::span<const int> offset, std::span<const int> members);

/// Symmetric matrix of 3 x 3 blocks, one triangle of it stored: the system matrix of a sheet, its
/// pattern fixed with the connectivity.
///
/// Rows are nodes in elimination order ("positions"). The blocks of a column stand one below the
/// other, the diagonal block complete, so that the column's values are a dense column-major panel
/// and a block is found by its start and the panel's height: that is how elements are scattered
/// without a search. The scalar view is a compressed matrix whose other triangle, in diagonal
/// blocks alone, must be ignored.
class BlockMatrix {
 public:
  /// Upper for Eigen's up-looking factorisation, lower for CHOLMOD: what each takes without a copy.
  enum class Triangle { upper, lower };
  using Sparse = Eigen::SparseMatrix<double>;

  BlockMatrix() = default;
  /// @param position  of each node in the elimination order
  BlockMatrix(const NodeGraph& graph, std::span<const int> position, Triangle triangle);

  [[nodiscard]] int nodes() const { return static_cast<int>(diagonal_.size()); }
  [[nodiscard]] Triangle triangle() const { return triangle_; }
  [[nodiscard]] std::size_t block_count() const { return rows_.size(); }
  /// Block rows stored in a column, ascending; its values are a panel of three times as many rows.
  [[nodiscard]] std::span<const int> column_rows(int column) const {
    const std::size_t begin = first_[column];
    const std::size_t end = first_[column + 1];
    return {rows_.data() + begin, end - begin};
  }
  [[nodiscard]] const double* column_values(int column) const {
    return sparse_.valuePtr() + 9 * first_[column];
  }
  [[nodiscard]] const Sparse& sparse() const { return sparse_; }
  [[nodiscard]] double* values() { return sparse_.valuePtr(); }
  void set_zero() { sparse_.coeffs().setZero(); }

  /// Where a block's first column starts among the values, and how far its columns are apart.
  struct Place {
    int start = 0;
    int stride = 0;
    bool transposed = false;  ///< the stored block is the one of (column, row)
  };
  /// @throws Error  on a block outside the pattern
  [[nodiscard]] Place place(int row, int column) const;
  [[nodiscard]] Eigen::Matrix3d block(const Place& place) const;
  /// Adds the block of (row, column); its transpose is implied.
  void add(const Place& place, const Eigen::Matrix3d& block);
  void add_to_diagonal(int position, double value);
  /// Adds a matrix of the same pattern.
  void add(const BlockMatrix& other) { sparse_.coeffs() += other.sparse_.coeffs(); }
  /// Euclidean norm of the scalar diagonal.
  [[nodiscard]] double diagonal_norm() const;

  /// y = A x, from the one triangle.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

  /// A block of (row, column) that was taken out.
  struct Taken {
    int row, column;
    Eigen::Matrix3d block;
  };
  /// Makes rows and columns of held positions those of the unit matrix, in the same pattern, and
  /// hands over what they were (each off-diagonal pair once).
  void take_out(std::span<const char> held, std::vector<Taken>& taken);

 private:
  Triangle triangle_ = Triangle::upper;
  std::vector<int> first_;     ///< of each block column in rows_ (n + 1)
  std::vector<int> rows_;      ///< block rows, ascending
  std::vector<int> diagonal_;  ///< start of each diagonal block among the values
  Sparse sparse_;
};

/// y += A x of blocks that were taken out.
void multiply_taken(std::span<const BlockMatrix::Taken> taken, const Eigen::VectorXd& x,
                    Eigen::VectorXd& y);

}  // namespace geoprior::paper
