#pragma once

#include <Eigen/Core>
#include <cmath>

namespace geoprior::paper {

/// Green strain G = (F'F - I) / 2 of a map F from the pattern into space.
inline Eigen::Matrix2d green_strain(const Eigen::Matrix<double, 3, 2>& F) {
  return (F.transpose() * F - Eigen::Matrix2d::Identity()) / 2;
}

/// Largest principal strain, in modulus.
inline double largest_principal(const Eigen::Matrix2d& G) {
  const double mean = (G(0, 0) + G(1, 1)) / 2;
  return std::abs(mean) + std::hypot((G(0, 0) - G(1, 1)) / 2, G(0, 1));
}

}  // namespace geoprior::paper
