#include "metrics/sound/true_peak.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "metrics/sound/spectrum.h"

namespace geoprior {
namespace {

constexpr int kPhases = 8;     ///< points a sample
constexpr int kHalfTaps = 16;  ///< samples on either side of a point
constexpr double kKaiserBeta = 8;

/// Modified Bessel function of the first kind, order 0, by its series.
double bessel_i0(double x) {
  double term = 1, sum = 1;
  for (int k = 1; term > 1e-17 * sum; ++k) {
    term *= x * x / (4. * k * k);
    sum += term;
  }
  return sum;
}

/// Row p: weights of the samples at -15 … 16 for the point at p / 8. They add up to 1, so that a
/// constant stays what it is.
Eigen::MatrixXd interpolation_weights() {
  Eigen::MatrixXd weights(kPhases, 2 * kHalfTaps);
  for (int p = 0; p < kPhases; ++p) {
    for (int j = 0; j < 2 * kHalfTaps; ++j) {
      const double x = static_cast<double>(j - kHalfTaps + 1) - static_cast<double>(p) / kPhases;
      const double sinc = x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
      const double inside = std::max(0., 1 - x * x / (kHalfTaps * kHalfTaps));
      weights(p, j) = sinc * bessel_i0(kKaiserBeta * std::sqrt(inside)) / bessel_i0(kKaiserBeta);
    }
    weights.row(p) /= weights.row(p).sum();
  }
  return weights;
}

}  // namespace

double true_peak(const Eigen::Ref<const Eigen::VectorXd>& samples) {
  const Eigen::Index n = samples.size();
  require_finite_samples(samples);
  Eigen::VectorXd padded = Eigen::VectorXd::Zero(n + 2 * kHalfTaps);
  padded.segment(kHalfTaps, n) = samples;
  const Eigen::MatrixXd weights = interpolation_weights();
  double peak = padded.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i + 2 * kHalfTaps <= padded.size(); ++i) {
    peak = std::max(peak, (weights * padded.segment(i, 2 * kHalfTaps)).cwiseAbs().maxCoeff());
  }
  return peak;
}

double decibels_full_scale(double amplitude) { return 20 * std::log10(amplitude); }

}  // namespace geoprior
