#pragma once

#include <Eigen/Core>

namespace geoprior::torus {

/// Values of the periodic cubic spline through (knot_k, value_k), at ascending places.
///
/// @param knots   n ascending numbers; the next period begins at knots(0) + 1
/// @param values  a row each
/// @param at      ascending, within one period from at(0)
/// @throws Error  where two knots do not ascend
Eigen::MatrixX3d periodic_spline(const Eigen::VectorXd& knots, const Eigen::MatrixX3d& values,
                                 const Eigen::VectorXd& at);

}  // namespace geoprior::torus
