#pragma once

#include <memory>

#include "models/paper/cholesky/sparse_cholesky.h"

namespace geoprior::paper {

/// Supernodal L L' of CHOLMOD, one BLAS thread: lower triangle; for large sheets.
std::unique_ptr<SparseCholesky> make_cholmod_cholesky(const BlockMatrix& matrix);

}  // namespace geoprior::paper
