#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <numbers>

namespace geoprior::fluid {

/// Fourier coefficients of N x N heights, row ky, column kx in 0 … N-1, by the sum itself:
/// independent of the library that made them.
inline Eigen::MatrixXcd ocean_modes(const Eigen::VectorXd& heights, int n) {
  Eigen::MatrixXcd dft(n, n);
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < n; ++i) {
      dft(k, i) = std::polar(1.0 / n, -2 * std::numbers::pi * ((k * i) % n) / n);
    }
  }
  const Eigen::MatrixXd h = Eigen::Map<const Eigen::MatrixXd>(heights.data(), n, n).transpose();
  return dft * h.cast<std::complex<double>>() * dft.transpose();
}

/// Waves along the patch of a row or column of the coefficients.
inline int waves_of(int index, int n) { return index <= n / 2 ? index : index - n; }

}  // namespace geoprior::fluid
