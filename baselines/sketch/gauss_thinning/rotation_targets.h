#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/connectivity.h"
#include "core/mesh.h"
#include "models/sketch/surface/position_cholesky.h"

namespace geoprior::sketch {

/// What a triangle weighs in a least-squares fit of triangles.
enum class TriangleWeight {
  area,     ///< its area: the cotangent matrix, even on irregular meshes
  uniform,  ///< the same for all (the sum of eq. 2.2 as it is written)
};

/// The surface whose triangles follow given rotations best (deformation transfer):
///
///   X* = argmin over X of  sum_t w_t || grad X - R_t (I - n_t n_t') grad X0 ||^2           (a)
///
/// Eq. 2.2 of the thesis is sum_t || P' P^-1 - R_t ||_F^2 with a fourth point p4 off every triangle
/// along its normal n_t. p4' of a triangle occurs in that triangle only; eliminating it leaves (a)
/// with w_t = 1, in which R_t enters by its action on the plane of the triangle alone. The residual
/// of (a) is linear on a triangle, so that (a) is, with c_ij the cotangent opposite to edge ij,
///
///   sum_t w_t / (2 area_t) sum_{ij in t} c_ij | (x_i - x_j) - R_t (y_i - y_j) |^2          (b)
///
/// where y are the positions that are rotated. Its matrix depends on weights only and is factorised
/// once; one vertex of each connected component is held in the solve, and the component is then
/// moved so that the mean of its vertices stays. Cotangents are those of `corner_cotangents`.
///
/// Source: Sumner and Popovic, Deformation Transfer for Triangle Meshes, 2004; thesis 2.1.2.
class RotationPoisson {
 public:
  /// @param reference  X0: any triangle mesh, open or closed; its cotangents are the weights
  /// @throws Error  on a vertex index out of range
  explicit RotationPoisson(const TriMesh& reference, TriangleWeight weight = TriangleWeight::area);

  /// @param rotations  one a triangle of X0; any 3 x 3 matrices are taken
  /// @return  n x 3 positions
  /// @throws Error  on a number of rotations that is not that of triangles
  [[nodiscard]] Eigen::MatrixX3d solve(std::span<const Eigen::Matrix3d> rotations) const;

  /// The same with the edges of other positions of the vertices (y in (b)) and the weights of X0.
  [[nodiscard]] Eigen::MatrixX3d solve(std::span<const Eigen::Matrix3d> rotations,
                                       const Eigen::MatrixX3d& positions) const;

  /// Value of (b) for positions `x` (m^2 for area weights: times the square of strain).
  [[nodiscard]] double energy(std::span<const Eigen::Matrix3d> rotations,
                              const Eigen::MatrixX3d& positions, const Eigen::MatrixX3d& x) const;

 private:
  void find_components();
  [[nodiscard]] Eigen::MatrixX3d right_hand_side(std::span<const Eigen::Matrix3d> rotations,
                                                 const Eigen::MatrixX3d& positions) const;
  /// Moves each component so that the mean of its vertices is that of `positions`.
  void keep_means(const Eigen::MatrixX3d& positions, Eigen::MatrixX3d& x) const;

  TriMesh reference_;
  Eigen::MatrixX3d cotangents_;  ///< by corner, times w_t / area_t
  VertexCorners corners_;
  std::vector<int> component_;  ///< of each vertex
  std::vector<int> held_;       ///< a vertex of each component
  std::optional<PositionCholesky> cholesky_;
};

}  // namespace geoprior::sketch
