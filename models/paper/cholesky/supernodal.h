#pragma once

#include <memory>

#include "models/paper/cholesky/sparse_cholesky.h"

namespace geoprior::paper {

/// Ours: multifrontal L L', dense kernels of 3 x 3 blocks, subtrees in parallel: lower triangle.
/// The bits of the solution do not depend on the number of threads.
std::unique_ptr<SparseCholesky> make_supernodal_cholesky(const BlockMatrix& matrix);

}  // namespace geoprior::paper
