#pragma once

#include <Eigen/Core>

namespace geoprior {

/// Fourier modes of a periodic height field: h(x, y) = sum over m, n of modes(m, n) e^{2 pi i (m x
/// / Lx + n y / Ly)}; indices above half stand for negative wave numbers.
/// @param heights  rows along x, columns along y (m)
Eigen::MatrixXcd fourier_modes(const Eigen::MatrixXd& heights);

/// A rectangular patch of water.
struct WavePatch {
  double size_x = 1, size_y = 1;  ///< edges (m)
  double gravity = 9.81;          ///< m/s^2
  double depth = 1000;            ///< m
  /// w(k) = sqrt(g k tanh(k H)) of the mode in row m and column n of a rows x cols table (rad/s).
  [[nodiscard]] double frequency(Eigen::Index m, Eigen::Index n, Eigen::Index rows,
                                 Eigen::Index cols) const;
  [[nodiscard]] Eigen::Vector2d wave_vector(Eigen::Index m, Eigen::Index n, Eigen::Index rows,
                                            Eigen::Index cols) const;
};

/// How far modes are from the dispersion relation.
struct DispersionError {
  int modes = 0;   ///< that could be measured
  double max = 0;  ///< largest |w_measured - w| / w
  double median = 0;
};

/// Frequencies measured from three states an interval apart: a wave of one frequency, whatever its
/// directions, obeys h(t + d) + h(t - d) = 2 cos(w d) h(t). Modes too weak to be measured (below
/// `floor` of the largest, or momentarily near a node) are left out, and those with w d above pi.
DispersionError dispersion_error(const Eigen::MatrixXcd& before, const Eigen::MatrixXcd& now,
                                 const Eigen::MatrixXcd& after, double interval,
                                 const WavePatch& patch, double floor = 1e-4);

/// Share of the variance carried by waves that run with the direction (0 … 1).
/// @param heights, rates  modes of h and of its time derivative
double share_running_along(const Eigen::MatrixXcd& heights, const Eigen::MatrixXcd& rates,
                           const Eigen::Vector2d& direction, const WavePatch& patch);

/// Mean, variance and kurtosis (3 for a Gaussian) of numbers.
struct Moments {
  double mean = 0, variance = 0, kurtosis = 3;
};
Moments moments(const Eigen::Ref<const Eigen::VectorXd>& values);

}  // namespace geoprior
