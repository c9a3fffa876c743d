#include "models/sound/voices/ring.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace geoprior::sound {
namespace {

using std::numbers::pi;

/// Half a period of a raised cosine, at the middle of sample i of n.
double rising(Eigen::Index i, Eigen::Index n) {
  return (1 - std::cos(pi * (static_cast<double>(i) + 0.5) / static_cast<double>(n))) / 2;
}

}  // namespace

void add_ringing(const RingingMode& mode, double eta, int rate, Eigen::Index start,
                 Eigen::Ref<Eigen::VectorXd> out) {
  const auto length = static_cast<Eigen::Index>(ringing_time(mode.frequency, eta) * rate) + 1;
  std::complex<double> z = std::polar(mode.amplitude, mode.phase);
  const std::complex<double> turn =
      std::polar(std::exp(-pi * eta * mode.frequency / rate), 2 * pi * mode.frequency / rate);
  const Eigen::Index end = std::min(out.size(), start + length);
  for (Eigen::Index i = start; i < end; ++i) {
    out[i] += z.imag();
    z *= turn;
  }
}

double ringing_time(double frequency, double eta) {
  return -std::log(kSilence) / (pi * eta * frequency);
}

double pulse_spectrum(double f, double tau) {
  const double x = f * tau;
  if (std::abs(x - 1) < 1e-6) return 0.5;
  const double sinc = x < 1e-9 ? 1 : std::sin(pi * x) / (pi * x);
  return std::abs(sinc / (1 - x * x));
}

void fade_in(Eigen::Ref<Eigen::VectorXd> out, Eigen::Index start, double seconds, int rate) {
  const auto n = static_cast<Eigen::Index>(seconds * rate);
  for (Eigen::Index i = 0; i < n && start + i < out.size(); ++i) out[start + i] *= rising(i, n);
}

void fade_out(Eigen::Ref<Eigen::VectorXd> out, int rate) {
  constexpr double kFade = 0.02;  // s
  const Eigen::Index n = std::min(out.size(), static_cast<Eigen::Index>(kFade * rate));
  for (Eigen::Index i = 0; i < n; ++i) out[out.size() - 1 - i] *= rising(i, n);
}

}  // namespace geoprior::sound
