#include "models/paper/cholesky/eigen.h"

#include <Eigen/SparseCholesky>
#include <cmath>

#include "core/error.h"

namespace geoprior::paper {
namespace {

/// Eigen answers for its factor only once factorised; its size is known from the analysis on.
class Ldlt final
    : public Eigen::SimplicialLDLT<BlockMatrix::Sparse, Eigen::Upper, Eigen::NaturalOrdering<int>> {
 public:
  [[nodiscard]] long nonzeros() const { return static_cast<long>(m_matrix.nonZeros() + cols()); }
};

class EigenCholesky final : public SparseCholesky {
 public:
  explicit EigenCholesky(const BlockMatrix& matrix) {
    if (matrix.triangle() != BlockMatrix::Triangle::upper) {
      throw Error("the lower triangle is stored", "Eigen's L D L'", "upper");
    }
    solver_.analyzePattern(matrix.sparse());
  }

  bool factorise(const BlockMatrix& matrix) override {
    solver_.factorize(matrix.sparse());
    if (solver_.info() != Eigen::Success) return false;
    // L D L' also succeeds on an indefinite matrix; a negated comparison catches NaN.
    const auto pivots = solver_.vectorD();
    for (Eigen::Index i = 0; i < pivots.size(); ++i) {
      if (!(pivots[i] > 0) || !std::isfinite(pivots[i])) return false;
    }
    return true;
  }

  void solve(Eigen::VectorXd& b) override {
    solver_.matrixL().solveInPlace(b);
    b.array() /= solver_.vectorD().array();
    solver_.matrixU().solveInPlace(b);
  }

  [[nodiscard]] long nonzeros() const override { return solver_.nonzeros(); }

 private:
  Ldlt solver_;
};

}  // namespace

std::unique_ptr<SparseCholesky> make_eigen_cholesky(const BlockMatrix& matrix) {
  return std::make_unique<EigenCholesky>(matrix);
}

}  // namespace geoprior::paper
