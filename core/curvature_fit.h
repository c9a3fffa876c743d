#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior {

/// Shape operators of a bent sheet from the dihedral angles of its triangles.
///
/// The height of a surface of constant curvature S over its pattern, w(u) = u' S u / 2, gives each
/// interior edge a jump of slope that is linear in S; so the dihedral angles about a triangle
/// determine S (three edges, three unknowns). The fit inverts that relation: S_T = sum_e B_Te
/// theta_e, exact for constant curvature on any mesh where it can be observed ("patch test"), which
/// the plain hinge energy is not. Triangles whose own edges do not determine S (borders, six points
/// on a conic) also use their neighbours' edges, least squares.
///
/// Where that is not enough, the triangles are strips and fans between rulings, whose vertices lie
/// on two lines or about an apex. There S is a sum of folds, the angle of each edge spread over
/// half the heights of the triangles beside it: exact for a cylinder over its rulings whatever
/// their slant, and bounded for a cone, whose curvature falls as 1/r along the rulings. What a fold
/// cannot do: bending along an unbroken ruling, or by rulings that are no edges, is seen wrongly.
struct CurvatureFit {
  static constexpr int kMostTerms = 12;
  static constexpr int kMostVertices = 12;

  struct Hinge {
    int a, b;         ///< the edge, as in the triangle `left`
    int left, right;  ///< triangles
    int c, d;         ///< vertices opposite to the edge in left and right
    /// Jump of the slope across the edge, left less right, per unit of S_uu, S_uv, S_vv (m).
    Eigen::Vector3d jump;
  };
  struct Term {
    int hinge;
    Eigen::Vector3d coefficient;  ///< of S_uu, S_uv, S_vv (1/m per rad)
  };
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
