#pragma once

#include <Eigen/Core>

namespace geoprior {

/// An interior edge of a sheet, with the two triangles that it hinges
/// (core/geometry/curvature_fit.h).
struct CurvatureHinge {
  int a, b;         ///< the edge, as in the triangle `left`
  int left, right;  ///< triangles
  int c, d;         ///< vertices opposite to the edge in left and right
  /// Jump of the slope across the edge, left less right, per unit of S_uu, S_uv, S_vv (m).
  Eigen::Vector3d jump;
};

/// What the angle of a hinge adds to the shape operator of a triangle.
struct CurvatureTerm {
  int hinge;
  Eigen::Vector3d coefficient;  ///< of S_uu, S_uv, S_vv (1/m per rad)
};

}  // namespace geoprior
