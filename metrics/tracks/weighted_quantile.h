#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace geoprior {

/// Smallest of the values such that the values up to it hold the given share of the weight (0.5:
/// weighted median). Ties keep the order of the values, so that the result does not depend on it.
///
/// @param values   at least one
/// @param weights  as many, not negative
/// @param share    0 to 1
/// @throws Error   on no values or unequal sizes
double weighted_quantile(const Eigen::VectorXd& values, const Eigen::VectorXd& weights,
                         double share);

/// The same of several shares, ascending: values are sorted once.
std::vector<double> weighted_quantiles(const Eigen::VectorXd& values,
                                       const Eigen::VectorXd& weights,
                                       std::span<const double> shares);

}  // namespace geoprior
