#pragma once

#include <Eigen/SparseCore>
#include <string>

#include "core/mesh.h"

namespace geoprior::skinning {

/// Third of the area of the triangles around each vertex (m^2).
Eigen::VectorXd vertex_areas(const TriMesh& mesh);

/// Cotangent Laplacian (positive semi-definite) of a conductivity that varies over the surface, one
/// factor a triangle. Every edge conducts at least 1e-5 times its triangles' mean factor: cotangent
/// weights below that, those of angles of more than 180 degrees together, are raised to it, so that
/// solutions keep the maximum principle on any mesh. The whole diagonal is stored.
Eigen::SparseMatrix<double> positive_cotangent_laplacian(const TriMesh& mesh,
                                                         const Eigen::VectorXd& conductivity);

/// The same with conductivity 1.
Eigen::SparseMatrix<double> positive_cotangent_laplacian(const TriMesh& mesh);

/// Square of a length given at the vertices, at the triangles: of the mean of their corners.
Eigen::VectorXd squared_at_triangles(const TriMesh& mesh, const Eigen::VectorXd& length);

/// Solutions of a symmetric positive definite system, one column a right-hand side: in parallel,
/// with the same bytes at any thread count.
/// @throws Error  when it is singular, naming what was to be solved
Eigen::MatrixXd solve_columns(const Eigen::SparseMatrix<double>& system, const Eigen::MatrixXd& rhs,
                              const std::string& what);

}  // namespace geoprior::skinning
