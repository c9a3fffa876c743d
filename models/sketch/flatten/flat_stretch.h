#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace geoprior::sketch {

/// Logarithm of a triangle's strain from the pattern to the surface: of the two singular values the
/// one farther from 1, positive where the surface is longer than the pattern.
///
/// @param flat_edges,edges  two edges from one corner, as columns; the third coordinate of flat
///                          ones is not looked at
inline double log_stretch(const Eigen::Matrix<double, 3, 2>& flat_edges,
                          const Eigen::Matrix<double, 3, 2>& edges) {
  const Eigen::Matrix2d flat = flat_edges.topRows<2>();
  const Eigen::Matrix<double, 3, 2> J = edges * flat.inverse();
  const Eigen::Matrix2d metric = J.transpose() * J;
  const double half = metric.trace() / 2;
  const double root = std::sqrt(std::max(0.0, half * half - metric.determinant()));
  const double larger = 0.5 * std::log(half + root);
  const double smaller = 0.5 * std::log(std::max(half - root, 1e-12));
  return std::abs(larger) >= std::abs(smaller) ? larger : smaller;
}

}  // namespace geoprior::sketch
