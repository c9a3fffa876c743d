#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "core/mesh.h"

namespace geoprior::sketch {

/// Cotangents of the angles of every triangle (m x 3, by corner), made safe for slivers: limited to
/// [-2, 20], and where the limits would make the triangle's Dirichlet energy
///   1/2 (cot a |x_b - x_c|^2 + cot b |x_c - x_a|^2 + cot c |x_a - x_b|^2)
/// negative for some values, the lowest one is raised until it is not
/// (cot a cot b + cot b cot c + cot c cot a >= 0, with equality to 1 for a true triangle).
Eigen::MatrixX3d corner_cotangents(const TriMesh& mesh);

/// Matrix K of sum over triangles of w_t times that energy, = 1/2 x' K x: symmetric, positive
/// semi-definite, constants in its kernel. All diagonal entries are stored.
///
/// @param cotangents  m x 3, already multiplied by w_t
Eigen::SparseMatrix<double> cotangent_stiffness(const Eigen::MatrixX3i& F,
                                                const Eigen::MatrixX3d& cotangents,
                                                int vertex_count);

}  // namespace geoprior::sketch
