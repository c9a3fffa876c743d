#pragma once

#include <Eigen/Core>
#include <array>

namespace geoprior::torus {

/// One of the three directions in which corrugations run over the unit square.
///
/// `covector` pi counts periods: a corrugation of number N has pi(x) N of them between the origin
/// and x, an integer around the torus. `along` V is in its kernel, `across` U is orthogonal to it
/// with pi(U) = 1.
struct WaveDirection {
  Eigen::Vector2d covector, along, across;
  /// |V|^2 = |pi|^2: a corrugation adds rho pi^2 / |pi|^2 to the metric.
  [[nodiscard]] double square() const { return along.squaredNorm(); }
};

inline const std::array<WaveDirection, 3> kDirections{
    WaveDirection{{-1, 0}, {0, 1}, {-1, 0}},
    WaveDirection{{-1, -2}, {-2, 1}, {-0.2, -0.4}},
    WaveDirection{{-1, 2}, {2, 1}, {-0.2, 0.4}},
};

/// Coefficient rho_i of a metric E dx^2 + 2 F dx dy + G dy^2 = sum of rho_i pi_i^2 / |pi_i|^2:
///   E = rho_0 + (rho_1 + rho_2) / 5,  F = 2 (rho_1 - rho_2) / 5,  G = 4 (rho_1 + rho_2) / 5.
template <class Scalar>
Scalar coefficient(int direction, const Scalar& E, const Scalar& F, const Scalar& G) {
  if (direction == 0) return E - 0.25 * G;
  if (direction == 1) return 0.625 * G + 1.25 * F;
  return 0.625 * G - 1.25 * F;
}

}  // namespace geoprior::torus
