#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/connectivity.h"
#include "metrics/developability/quadric_fit.h"
#include "metrics/isometry/shell_energy.h"

namespace geoprior {

/// Second fundamental form of a sheet in its pattern, from places alone: no dihedral angles, so
/// that it shares nothing with the elements of a solver.
///
/// About each triangle the three coordinates x(u, v) of the vertices that share a triangle with one
/// of its corners are fitted by quadrics over the pattern; then S_ij = n . x_ij with n along
/// x_u x x_v at the triangle's centroid. The fit is exact for quadrics on any mesh, and large turns
/// within a patch are no matter, since no height over a plane is taken. A patch whose vertices lie
/// on a conic gets another ring. Where that does not help (strips between rulings: all vertices lie
/// on two lines) one combination of S is free, and S is the least of those with det S = 0: the
/// sheet is developable.
///
/// What it cannot do: a patch is about three edges wide, so a fold along one edge is seen as a bend
/// of that width, with 0.42 of the energy of the same fold spread over the two triangles beside it
/// (core/geometry/curvature_fit.h). Where such a fold has become the rest curvature, an eighth of
/// that stays. A cone's curvature averages out where a patch has the apex in it: fans about an apex
/// are not measured (docs/metrics.md has the numbers on simulated sheets).
class QuadricCurvature {
 public:
  /// @param pattern    n x 2 (m)
  /// @param triangles  m x 3, counter-clockwise in the pattern
  /// @throws Error     on a triangle without area (names it)
  QuadricCurvature(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3i& triangles);

  /// S_uu, S_uv, S_vv of every triangle (m x 3, 1/m).
  [[nodiscard]] Eigen::MatrixX3d shape_operators(const Eigen::MatrixX3d& x) const;
  /// What a field on the triangles is over the patches: its mean by area over the triangles that
  /// touch each one.
  [[nodiscard]] Eigen::MatrixX3d patch_means(const Eigen::MatrixX3d& of_triangles) const;
  /// Of the triangles in the pattern (m^2).
  [[nodiscard]] const Eigen::VectorXd& areas() const { return area_; }

 private:
  struct Patch {
    std::vector<int> vertices;
    QuadricFit fit;
  };
  [[nodiscard]] Eigen::RowVector3d shape_operator(const Patch& patch,
                                                  const Eigen::MatrixX3d& x) const;

  Eigen::MatrixX3i triangles_;
  VertexCorners corners_;
  Eigen::VectorXd area_;
  std::vector<Patch> patches_;
};

/// Elastic energy of bending (J): sum of A D/2 ((1 - nu) |S|^2 + nu (tr S)^2), S the curvature of
/// `QuadricCurvature` less the rest curvature's mean over the same patch.
///
/// @param x               n x 3 (m)
/// @param rest_curvature  m x 3, S_uu, S_uv, S_vv (1/m)
/// @throws Error          unless `rest_curvature` has a row a triangle
double bending_energy(const QuadricCurvature& curvature, const Eigen::MatrixX3d& x,
                      const Eigen::MatrixX3d& rest_curvature, const PlateStiffness& plate);

}  // namespace geoprior
