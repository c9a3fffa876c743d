#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <span>

#include "models/sketch/flatten/flat_triangles.h"

namespace geoprior::sketch {

/// Hermitian matrix of the conformal energy of maps to the plane, lower triangle:
///   z' A z = 1/2 integral |grad z|^2 - area(z),
/// never negative and zero just for maps that preserve all angles. With the cotangents c_k opposite
/// to the edges,
///   z' A z = sum_t [ sum_k c_k |z_{k+1} - z_k|^2 / 4 - area_t(z) ],
///   area_t(z) = 1/2 sum_k Im(conj(z_k) z_{k+1}):
/// the least squares of Lévy et al. 2002 with one complex unknown a vertex. The terms of the area
/// cancel but along the border.
///
/// @param F    m x 3 vertices, 0 … vertex_count - 1
/// @param cot  of every triangle, opposite to its edges
/// Source: Pinkall and Polthier 1993; Lévy et al. 2002; Mullen, Tong, Alliez, Desbrun 2008.
Eigen::SparseMatrix<Complex> conformal_energy(const Eigen::MatrixX3i& F,
                                              std::span<const std::array<double, 3>> cot,
                                              int vertex_count);
Eigen::SparseMatrix<Complex> conformal_energy(const Eigen::MatrixX3i& F,
                                              std::span<const FlatTriangle> triangles,
                                              int vertex_count);

/// The map of least conformal energy among those with two given vertices at given places.
/// @throws Error  when the two are the same vertex, or the matrix cannot be factorised
Eigen::VectorXcd pinned_conformal_map(const Eigen::SparseMatrix<Complex>& energy,
                                      std::array<int, 2> pins, std::array<Complex, 2> places);

/// The map of least conformal energy among those whose border has unit moment of inertia about its
/// centre: no vertex is singled out (spectral conformal map).
///
/// Inverse iteration on A z = lambda B z, B the lumped lengths of the border, with the constant
/// maps projected out. Not scaled and not turned in any particular way.
///
/// @throws Error  on a mesh without border, or when the matrix cannot be factorised
/// Source: Mullen, Tong, Alliez, Desbrun, Spectral Conformal Parameterization, 2008.
Eigen::VectorXcd spectral_conformal_map(const TriMesh& mesh,
                                        const Eigen::SparseMatrix<Complex>& energy);

}  // namespace geoprior::sketch
