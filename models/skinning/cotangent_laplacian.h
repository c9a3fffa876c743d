#pragma once

#include <Eigen/SparseCore>

#include "core/mesh.h"

namespace geoprior::skinning {

/// Cotangent Laplacian (positive semi-definite, rows sum to 0) with edge weights of at least 1e-5:
/// its inverse problems keep values between those that are given, on any mesh, and every edge
/// conducts.
///
/// @param mesh  any triangle mesh, n vertices
/// @return      n x n; the row of a vertex without triangles is empty
Eigen::SparseMatrix<double> positive_cotangent_laplacian(const TriMesh& mesh);

}  // namespace geoprior::skinning
