#pragma once

#include <Eigen/SparseCore>
#include <memory>

namespace geoprior {

/// P A Pᵀ = L D Lᵀ of a sparse symmetric matrix, of which the lower triangle is read; P by minimum
/// degree. Also of indefinite matrices, whose pivots are not chosen: where one is zero it fails.
///
/// Eigen's SimplicialLDLT, compiled once; the same bits as calling it.
class SparseLdlt {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  SparseLdlt();
  explicit SparseLdlt(const Matrix& A);  ///< analyses and factorises
  SparseLdlt(SparseLdlt&& other) noexcept;
  SparseLdlt& operator=(SparseLdlt&& other) noexcept;
  ~SparseLdlt();

  /// Order and pattern of L for all matrices with these non-zeros.
  void analyze(const Matrix& pattern);
  /// Of A + shift I, after `analyze`.
  void factorize(const Matrix& A, double shift = 0);
  /// Whether the last factorisation succeeded; the rest may be asked only then.
  [[nodiscard]] bool succeeded() const;
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// Column by column.
  [[nodiscard]] Eigen::MatrixXd solve_columns(const Eigen::Ref<const Eigen::MatrixXd>& B) const;
  /// The pivots D: as many are negative as eigenvalues are (Sylvester).
  [[nodiscard]] Eigen::VectorXd pivots() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace geoprior
