#pragma once

#include <Eigen/Core>
#include <optional>

namespace geoprior {

/// Least-squares quadric f(p) = a + b.p + p'Cp/2 through values at points of a plane, as weights of
/// the values. Exact for quadratics wherever the points determine them.
///
/// Points on a conic do not: adding the conic's equation changes no value. `unobserved` counts such
/// quadratics; along them C is the least in the points' own scale (they are made to have unit
/// covariance first), and an affine function is still reproduced.
struct QuadricFit {
  enum Column { kValue, kU, kV, kUU, kUV, kVV };

  /// n x 6: row i has the weights of the value at point i in f, f_u, f_v, f_uu, f_uv and f_vv at
  /// the origin.
  Eigen::Matrix<double, Eigen::Dynamic, 6> weights;
  int unobserved = 0;                               ///< 0 ... 3
  Eigen::Vector3d conic = Eigen::Vector3d::Zero();  ///< C_uu, C_uv, C_vv of the last of these
};

/// Quadratics whose sum of squares is below this part of the largest one's count as not observed.
inline constexpr double kLeastObserved = 1e-4;

/// @param points  n x 2, relative to where f is wanted
/// @return        none for fewer than 3 points, or points of one line
std::optional<QuadricFit> fit_quadric(const Eigen::MatrixX2d& points);

}  // namespace geoprior
