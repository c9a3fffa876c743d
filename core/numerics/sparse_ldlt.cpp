#include "core/numerics/sparse_ldlt.h"

#include <Eigen/SparseCholesky>

namespace geoprior {

struct SparseLdlt::Impl {
  Eigen::SimplicialLDLT<Matrix> factor;
};

SparseLdlt::SparseLdlt() : impl_(std::make_unique<Impl>()) {}
SparseLdlt::SparseLdlt(const Matrix& A) : SparseLdlt() { impl_->factor.compute(A); }
SparseLdlt::SparseLdlt(SparseLdlt&& other) noexcept = default;
SparseLdlt& SparseLdlt::operator=(SparseLdlt&& other) noexcept = default;
SparseLdlt::~SparseLdlt() = default;

void SparseLdlt::analyze(const Matrix& pattern) { impl_->factor.analyzePattern(pattern); }

void SparseLdlt::factorize(const Matrix& A, double shift) {
  impl_->factor.setShift(shift);
  impl_->factor.factorize(A);
}

bool SparseLdlt::succeeded() const { return impl_->factor.info() == Eigen::Success; }

Eigen::VectorXd SparseLdlt::solve(const Eigen::VectorXd& b) const { return impl_->factor.solve(b); }

Eigen::MatrixXd SparseLdlt::solve_columns(const Eigen::Ref<const Eigen::MatrixXd>& B) const {
  return impl_->factor.solve(B);
}

Eigen::VectorXd SparseLdlt::pivots() const { return impl_->factor.vectorD(); }

}  // namespace geoprior
