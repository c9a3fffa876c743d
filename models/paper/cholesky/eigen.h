#pragma once

#include <memory>

#include "models/paper/cholesky/sparse_cholesky.h"

namespace geoprior::paper {

/// Up-looking L D L' of Eigen: upper triangle; fastest for small sheets.
std::unique_ptr<SparseCholesky> make_eigen_cholesky(const BlockMatrix& matrix);

}  // namespace geoprior::paper
