#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/geometry/curvature_hinge.h"

namespace geoprior {

/// A symmetric 2 x 2 matrix as (uu, sqrt2 uv, vv): Frobenius products are dot products.
Eigen::Vector3d mandel(const Eigen::Matrix2d& S);

/// S at a triangle from the angles of its edges or of those around it: the solution of
/// jump_e . S = theta_e, where it is determined, else a sum of folds
/// (core/geometry/curvature_fit.h). Exact for constant curvature, but its constant moments are not
/// in equilibrium.
struct CurvatureEstimate {
  std::vector<CurvatureTerm> terms;  ///< coefficients as (uu, sqrt2 uv, vv)
  int rank = 0;                      ///< of the equations; under 3: folds
};

/// @param hinges       with their jumps
/// @param of_triangle  hinge at each edge of each triangle, -1 at the border
CurvatureEstimate estimate_curvature(const Eigen::MatrixX2d& pattern,
                                     const std::vector<CurvatureHinge>& hinges,
                                     const std::vector<std::array<int, 3>>& of_triangle,
                                     int triangle);

}  // namespace geoprior
