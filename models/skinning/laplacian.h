#pragma once

#include <Eigen/SparseCore>

#include "core/mesh.h"

namespace geoprior::skinning {

/// Cotangent Laplacian of a mesh without negative edge weights (positive semi-definite, n x n; rows
/// sum to zero), and the area around each vertex: a third of its triangles' (m^2).
///
/// Negative weights of an edge (opposite angles of more than 180 degrees together) are raised to
/// almost zero, so that a maximum principle holds; cotangents of slivers are bounded.
struct SurfaceLaplacian {
  Eigen::SparseMatrix<double> stiffness;
  Eigen::VectorXd area;
};
SurfaceLaplacian positive_cotangent_laplacian(const TriMesh& mesh);

}  // namespace geoprior::skinning
