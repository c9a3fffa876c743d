#include "models/sketch/surface/position_cholesky.h"

#include <Eigen/SparseCholesky>

#include "core/error.h"

namespace geoprior::sketch {

PositionCholesky::PositionCholesky(const Eigen::SparseMatrix<double>& matrix,
                                   const std::string& what) {
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky(matrix);
  if (cholesky.info() != Eigen::Success)
    throw Error("the system is not positive definite", what, "triangles of finite size");
  const Eigen::SparseMatrix<double> lower = cholesky.matrixL();
  begin_.push_back(0);
  for (int column = 0; column < lower.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(lower, column); it; ++it) {
      if (it.row() == column) {
        pivot_.push_back(1 / it.value());
      } else {
        row_.push_back(static_cast<int>(it.row()));
        entry_.push_back(it.value());
      }
    }
    begin_.push_back(static_cast<int>(row_.size()));
  }
  place_ = cholesky.permutationP().indices();
  if (place_.size() == 0) {  // Eigen leaves the order as it is for a diagonal matrix of size 0
    place_.setLinSpaced(matrix.rows(), 0, static_cast<int>(matrix.rows()) - 1);
  }
}

void PositionCholesky::solve(Eigen::MatrixX3d& values) const {
  // A fourth value that stays zero makes a vertex one register.
  Eigen::Matrix4Xd x = Eigen::Matrix4Xd::Zero(4, values.rows());
  for (Eigen::Index v = 0; v < values.rows(); ++v)
    x.col(place_(v)).head<3>() = values.row(v).transpose();
  const auto n = static_cast<int>(values.rows());
  for (int j = 0; j < n; ++j) {
    const Eigen::Vector4d solved = x.col(j) * pivot_[j];
    x.col(j) = solved;
    for (int e = begin_[j]; e < begin_[j + 1]; ++e) x.col(row_[e]) -= entry_[e] * solved;
  }
  for (int j = n - 1; j >= 0; --j) {
    Eigen::Vector4d rest = x.col(j);
    for (int e = begin_[j]; e < begin_[j + 1]; ++e) rest -= entry_[e] * x.col(row_[e]);
    x.col(j) = rest * pivot_[j];
  }
  for (Eigen::Index v = 0; v < values.rows(); ++v)
    values.row(v) = x.col(place_(v)).head<3>().transpose();
}

}  // namespace geoprior::sketch
