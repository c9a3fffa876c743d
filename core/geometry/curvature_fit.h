#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/curvature_hinge.h"

namespace geoprior {

/// Shape operators of a bent sheet from the dihedral angles of its triangles.
///
/// The plane of a triangle meets the smooth surface at an angle alpha_e along each of its edges,
/// and
///   S_T = 1/A_T sum_e l_e alpha_e n_e n_e'        (n_e: unit normal of the edge in the pattern)
/// exactly where S is constant. At an interior edge the angles of the two sides add up to the
/// dihedral angle, alpha = theta/2 + beta and theta/2 - beta; beta comes from an estimate of S at
/// the edge, which solves for the S whose jumps of slope are the angles of the edges around (three
/// edges, three unknowns; least squares with farther edges at borders). So
///  - S is exact for constant curvature on any mesh (patch test for angles),
///  - sum_T A_T S_T = sum_e l_e theta_e n_e n_e' whatever beta: the forces of a constant moment
///  vanish
///    at interior vertices (patch test for forces). Without it a mesh finds wiggles that bend it
///    with less energy than the plate's.
/// The plain hinge energy has neither.
///
/// Where the edges around do not determine S, the triangles are strips and fans between rulings,
/// whose vertices lie on two lines or about an apex. There S is a sum of folds, the angle of each
/// edge spread over half the heights of the triangles beside it: exact for a cylinder over its
/// rulings whatever their slant, and bounded for a cone, whose curvature falls as 1/r along the
/// rulings. What a fold cannot do: bending along an unbroken ruling, or by rulings that are no
/// edges, is seen wrongly.
///
/// Source: the constant-moment plate element (Morley 1971; Hellan, Herrmann, Johnson) with its
/// edge unknown beta estimated instead of solved for; beta = 0 is the basic shell triangle of Onate
/// and Zarate 2000.
struct CurvatureFit {
  static constexpr int kMostTerms = 16;
  static constexpr int kMostVertices = 16;
  using Hinge = CurvatureHinge;
  using Term = CurvatureTerm;
  std::vector<Hinge> hinges;  ///< interior edges
  /// Of each triangle, at most `kMostTerms`; its own edges come first. Together they touch at most
  /// `kMostVertices` vertices.
  std::vector<std::vector<Term>> terms;
  std::vector<int> own;      ///< terms of each triangle that are its own edges, 0 ... 3
  std::vector<int> rank;     ///< components of S that the terms observe; under 3: folds
  std::vector<double> area;  ///< of each triangle in the pattern (m^2)
};

/// @param pattern    n x 2 (m)
/// @param triangles  m x 3, counter-clockwise in the pattern, manifold
/// @throws Error     on a triangle without area (names it) or a non-manifold edge
CurvatureFit fit_curvature(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3i& triangles);

/// Signed dihedral angle of a hinge (rad), 0 when flat, positive when the sheet is a valley seen
/// from the side of its normals (so that w = + u' S u / 2 gives positive angles for positive S).
double dihedral_angle(const Eigen::MatrixX3d& x, const CurvatureFit::Hinge& hinge);

/// Shape operators S_uu, S_uv, S_vv of all triangles (m x 3, 1/m).
Eigen::MatrixX3d shape_operators(const CurvatureFit& fit, const Eigen::MatrixX3d& x);

}  // namespace geoprior
