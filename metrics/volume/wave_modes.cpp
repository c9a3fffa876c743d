#include "metrics/volume/wave_modes.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace geoprior {
namespace {

using std::numbers::pi;

/// Row m, column x: e^{-2 pi i m x / n} / n.
Eigen::MatrixXcd transform_matrix(Eigen::Index n) {
  Eigen::MatrixXcd matrix(n, n);
  for (Eigen::Index m = 0; m < n; ++m) {
    for (Eigen::Index x = 0; x < n; ++x) {
      // m x mod n keeps the angle small, and the transform exact to round-off.
      const double angle = -2 * pi * static_cast<double>((m * x) % n) / static_cast<double>(n);
      matrix(m, x) = std::polar(1.0 / static_cast<double>(n), angle);
    }
  }
  return matrix;
}

double signed_number(Eigen::Index m, Eigen::Index n) {
  return static_cast<double>(2 * m < n ? m : m - n);
}

}  // namespace

Eigen::MatrixXcd fourier_modes(const Eigen::MatrixXd& heights) {
  const Eigen::MatrixXcd along_x = transform_matrix(heights.rows());
  const Eigen::MatrixXcd along_y = transform_matrix(heights.cols());
  return along_x * heights.cast<std::complex<double>>() * along_y.transpose();
}

Eigen::Vector2d WavePatch::wave_vector(Eigen::Index m, Eigen::Index n, Eigen::Index rows,
                                       Eigen::Index cols) const {
  return {2 * pi * signed_number(m, rows) / size_x, 2 * pi * signed_number(n, cols) / size_y};
}

double WavePatch::frequency(Eigen::Index m, Eigen::Index n, Eigen::Index rows,
                            Eigen::Index cols) const {
  const double k = wave_vector(m, n, rows, cols).norm();
  return std::sqrt(gravity * k * std::tanh(k * depth));
}

DispersionError dispersion_error(const Eigen::MatrixXcd& before, const Eigen::MatrixXcd& now,
                                 const Eigen::MatrixXcd& after, double interval,
                                 const WavePatch& patch, double floor) {
  if (now.size() == 0) return {};
  const double weakest = floor * now.cwiseAbs().maxCoeff();
  std::vector<double> errors;
  for (Eigen::Index m = 0; m < now.rows(); ++m) {
    for (Eigen::Index n = 0; n < now.cols(); ++n) {
      const double expected = patch.frequency(m, n, now.rows(), now.cols());
      const double amplitude = std::abs(now(m, n));
      const double beside = (std::abs(before(m, n)) + std::abs(after(m, n))) / 2;
      const bool measurable = expected > 0 && expected * interval < pi && amplitude > weakest &&
                              amplitude > 0.1 * beside;
      if (!measurable) continue;
      const double cosine = ((before(m, n) + after(m, n)) * std::conj(now(m, n))).real() /
                            (2 * amplitude * amplitude);
      const double measured = std::acos(std::clamp(cosine, -1.0, 1.0)) / interval;
      errors.push_back(std::abs(measured - expected) / expected);
    }
  }
  DispersionError result;
  result.modes = static_cast<int>(errors.size());
  if (errors.empty()) return result;
  std::sort(errors.begin(), errors.end());
  result.max = errors.back();
  result.median = errors[errors.size() / 2];
  return result;
}

double share_running_along(const Eigen::MatrixXcd& heights, const Eigen::MatrixXcd& rates,
                           const Eigen::Vector2d& direction, const WavePatch& patch) {
  double along = 0, all = 0;
  const std::complex<double> i(0, 1);
  for (Eigen::Index m = 0; m < heights.rows(); ++m) {
    for (Eigen::Index n = 0; n < heights.cols(); ++n) {
      const double w = patch.frequency(m, n, heights.rows(), heights.cols());
      if (w == 0) continue;
      // h = a e^{-iwt} + b e^{+iwt}: a runs along +k, and i h' / w = a - b.
      const double variance = std::norm((heights(m, n) + i * rates(m, n) / w) / 2.0);
      const Eigen::Vector2d k = patch.wave_vector(m, n, heights.rows(), heights.cols());
      all += variance;
      if (k.dot(direction) > 0) along += variance;
    }
  }
  return all > 0 ? along / all : 0;
}

Moments moments(const Eigen::Ref<const Eigen::VectorXd>& values) {
  Moments result;
  if (values.size() == 0) return result;
  result.mean = values.mean();
  const Eigen::ArrayXd centred = values.array() - result.mean;
  result.variance = centred.square().mean();
  if (result.variance > 0) {
    result.kurtosis = centred.square().square().mean() / (result.variance * result.variance);
  }
  return result;
}

}  // namespace geoprior
