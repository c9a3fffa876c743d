#include "core/inputs/sound.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "core/error.h"

namespace geoprior {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRipple_dB = 100;
/// Of the lower sample rate: pass band to 0.45, stop band from 0.5.
constexpr double kTransition = 0.05;

/// Kaiser's β for a ripple above 50 dB.
constexpr double kBeta = 0.1102 * (kRipple_dB - 8.7);
/// Kaiser's length of the window for that ripple and transition, in periods of the lower rate.
constexpr double kLength = (kRipple_dB - 7.95) / (2.285 * 2 * kPi * kTransition);

/// Modified Bessel function of the first kind, order 0, by its power series.
double bessel_i0(double x) {
  double sum = 1, term = 1;
  for (int k = 1; term > 1e-17 * sum; ++k) {
    term *= (x / (2 * k)) * (x / (2 * k));
    sum += term;
  }
  return sum;
}

double sinc(double x) { return x == 0 ? 1 : std::sin(kPi * x) / (kPi * x); }

/// The low pass at `t` samples of the input from its middle.
/// @param band  lower over input rate
double low_pass(double t, double band) {
  const double reach = 0.5 * kLength / band;
  if (std::abs(t) >= reach) return 0;
  const double cutoff = (0.5 - 0.5 * kTransition) * band;  // middle of the transition
  const double u = t / reach;
  return 2 * cutoff * sinc(2 * cutoff * t) * bessel_i0(kBeta * std::sqrt(1 - u * u)) /
         bessel_i0(kBeta);
}

/// Input samples that an output sample is made of: `weights` for `first`, `first` + 1, …
struct Kernel {
  std::int64_t first = 0;
  Eigen::VectorXd weights;
};

/// Of the output sample at `position` (input samples). The weights sum to 1, so that a constant
/// stays what it is in every phase.
Kernel kernel_at(double position, double band) {
  const double reach = 0.5 * kLength / band;
  Kernel kernel;
  kernel.first = static_cast<std::int64_t>(std::ceil(position - reach));
  const auto last = static_cast<std::int64_t>(std::floor(position + reach));
  kernel.weights.resize(last - kernel.first + 1);
  for (Eigen::Index k = 0; k < kernel.weights.size(); ++k) {
    kernel.weights[k] = low_pass(position - static_cast<double>(kernel.first + k), band);
  }
  kernel.weights /= kernel.weights.sum();
  return kernel;
}

/// The kernel's sum over the input from `first` on; outside of it there is silence.
Eigen::RowVectorXd weighted(const Eigen::MatrixXd& in, const Eigen::VectorXd& weights,
                            std::int64_t first) {
  const std::int64_t begin = std::max<std::int64_t>(first, 0);
  const std::int64_t end = std::min<std::int64_t>(first + weights.size(), in.rows());
  if (begin >= end) return Eigen::RowVectorXd::Zero(in.cols());
  return weights.segment(begin - first, end - begin).transpose() *
         in.middleRows(begin, end - begin);
}

}  // namespace

void require_sample_rate(int sample_rate, const std::string& where) {
  if (sample_rate >= kLeastSampleRate && sample_rate <= kMostSampleRate) return;
  throw Error("has a sample rate of " + std::to_string(sample_rate) + " Hz", where,
              std::to_string(kLeastSampleRate) + " to " + std::to_string(kMostSampleRate) + " Hz");
}

Sound resampled(const Sound& sound, int sample_rate) {
  require_sample_rate(sound.sample_rate, "sound that is resampled");
  require_sample_rate(sample_rate, "resampled sound");
  if (sample_rate == sound.sample_rate) return sound;
  // Output sample n lies at n down / up of the input: samples that are `up` apart share a phase.
  const std::int64_t common = std::gcd(sound.sample_rate, sample_rate);
  const std::int64_t up = sample_rate / common, down = sound.sample_rate / common;
  const double band = std::min(1.0, static_cast<double>(up) / static_cast<double>(down));
  Sound out{sample_rate,
            Eigen::MatrixXd((sound.samples.rows() * up + down - 1) / down, sound.samples.cols())};
  for (std::int64_t phase = 0; phase < std::min<std::int64_t>(up, out.samples.rows()); ++phase) {
    const double position = static_cast<double>(phase * down) / static_cast<double>(up);
    Kernel kernel = kernel_at(position, band);
    for (Eigen::Index n = phase; n < out.samples.rows(); n += up, kernel.first += down) {
      out.samples.row(n) = weighted(sound.samples, kernel.weights, kernel.first);
    }
  }
  return out;
}

}  // namespace geoprior
