#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/curvature_fit.h"
#include "metrics/isometry/shell_energy.h"

namespace geoprior {

/// The folds of a sheet along the edges of its mesh, each with the side to which it bends the
/// sheet.
///
/// A sheet that is bent one way does not fold all edges one way: on a mesh of equilateral triangles
/// the edges along the bend fold back, by a quarter of what the others fold. So a fold counts
/// relative to its edge: as positive when its angle has the sign that it has on a cylinder of
/// positive curvature, bent in the direction d in which the sheet is folded there: that of the
/// cylinder whose folds, whatever their signs, have sizes most like those of the hinges about.
struct SheetFolds {
  std::vector<double> angle;          ///< theta of each hinge, positive where d says so (rad)
  std::vector<Eigen::Vector2d> a, b;  ///< ends of its edge in the pattern (m)
};

/// @param fit      of the pattern and the triangles
/// @param pattern  n x 2 (m)
/// @param x        n x 3 (m)
SheetFolds sheet_folds(const CurvatureFit& fit, const Eigen::MatrixX2d& pattern,
                       const Eigen::MatrixX3d& x);

/// Share of the folds that opposite ones nearby cancel: over discs of the pattern
///   sum min(M+, M-) / (1/2 sum (M+ + M-)),   M+, M-: sums of l |theta| over the positive and the
/// negative folds, l the length of the edge within the disc.
///
/// 0 for cylinders and cones, whatever their mesh; 1 for pleats closer than the disc is wide. A
/// sheet that bends to both sides within a disc counts too, so that shares of two meshes are
/// compared by one radius. 0 for a flat sheet. A cylinder along the diagonals of oblongs of 2 to 1
/// whose diagonals alternate is misjudged: 0.5.
///
/// @param radius  of the discs, whose centres are a square grid of half the radius (m)
/// @throws Error  on a radius that is not positive, or with more than 2^24 discs
double cancelling_share(const SheetFolds& folds, double radius);

/// Elastic energy of bending with every fold counted for itself (J): what a plate has to bend by
/// the angle of the fold over the triangles beside it,
///   sum over triangles T of c_T times the sum over its hinges of D l^2 (theta - theta_p)^2 / (4
///   (A1 + A2)).
/// c_T makes it the plate's energy on cylinders: with q_e the angle of an edge per unit of
/// curvature when the sheet is a cylinder bent in the direction d of `SheetFolds`,
///   c_T = A / sum of l^2 q_e^2 / (2 (A1 + A2)),   A: area of T and its neighbours
/// over the hinges of each of them, and at most 1.5. Folds of opposite sign add up, where
/// `bending_energy` may see their sum alone.
///
/// @param rest_curvature  m x 3, S_uu, S_uv, S_vv (1/m); theta_p is the angle that it gives an edge
/// @throws Error          unless `rest_curvature` has a row a triangle
double fold_energy(const CurvatureFit& fit, const Eigen::MatrixX2d& pattern,
                   const Eigen::MatrixX3d& x, const Eigen::MatrixX3d& rest_curvature,
                   const PlateStiffness& plate);

}  // namespace geoprior
