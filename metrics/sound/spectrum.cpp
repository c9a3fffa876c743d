#include "metrics/sound/spectrum.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <string>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "core/error.h"
#include "metrics/tracks/of_values.h"

namespace geoprior {

void require_finite_samples(const Eigen::Ref<const Eigen::VectorXd>& samples) {
  for (Eigen::Index i = 0; i < samples.size(); ++i) {
    if (!std::isfinite(samples(i))) throw Error("it is not finite", "sample " + std::to_string(i));
  }
}

namespace {

void require_sound(const Eigen::Ref<const Eigen::VectorXd>& samples, int sample_rate) {
  if (sample_rate < 1) {
    throw Error("sample rate " + std::to_string(sample_rate) + " Hz", "sound", "at least 1");
  }
  if (samples.size() == 0) throw Error("no samples", "sound");
  require_finite_samples(samples);
}

/// Periodic Hann window of n samples.
Eigen::VectorXd hann_window(Eigen::Index n) {
  const Eigen::ArrayXd i = Eigen::ArrayXd::LinSpaced(n, 0, static_cast<double>(n - 1));
  return 0.5 - 0.5 * (2 * std::numbers::pi / static_cast<double>(n) * i).cos();
}

/// Spectra of windowed sounds of one length, padded to another.
class Periodogram {
 public:
  Periodogram(Eigen::VectorXd window, Eigen::Index padded, int sample_rate)
      : window_(std::move(window)), padded_(Eigen::VectorXd::Zero(padded)), rate_(sample_rate) {
    transform_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    modes_.resize(padded / 2 + 1);
  }
  /// @param samples  as many as the window has
  Eigen::VectorXd operator()(const Eigen::Ref<const Eigen::VectorXd>& samples) {
    padded_.head(window_.size()) = samples.cwiseProduct(window_);
    transform_.fwd(modes_.data(), padded_.data(), padded_.size());
    return 2 / (rate_ * window_.squaredNorm()) * modes_.cwiseAbs2();
  }

 private:
  Eigen::VectorXd window_, padded_;
  Eigen::VectorXcd modes_;
  Eigen::FFT<double> transform_;
  double rate_;
};

/// Share of bin k that lies between two frequencies, in Hz.
double width_within(const PowerSpectrum& s, Eigen::Index k, double low, double high) {
  const double middle = static_cast<double>(k) * s.step_hz;
  const double top = static_cast<double>(s.density.size() - 1) * s.step_hz;
  const double from = std::max({middle - s.step_hz / 2, low, 0.});
  const double to = std::min({middle + s.step_hz / 2, high, top});
  return std::max(0., to - from);
}

/// Sums f^moment x power over the bins between two frequencies.
double spectral_moment(const PowerSpectrum& s, int moment, double low, double high) {
  double sum = 0;
  auto k = static_cast<Eigen::Index>(std::max(0., std::floor(low / s.step_hz - 0.5)));
  for (; k < s.density.size() && (static_cast<double>(k) - 0.5) * s.step_hz < high; ++k) {
    const double power = s.density(k) * width_within(s, k, low, high);
    sum += moment == 0 ? power : power * static_cast<double>(k) * s.step_hz;
  }
  return sum;
}

double band_edge(int band) { return 1000 * std::pow(10., (2 * (band - 16) - 1) / 20.); }

std::optional<Eigen::VectorXd> relative_levels(const Eigen::VectorXd& power, double floor_db) {
  if (!(floor_db > 0)) {
    throw Error("floor of " + std::to_string(floor_db) + " dB", "third-octave levels", "positive");
  }
  const std::optional<double> most = largest_of(power);
  if (!most || !(*most > 0)) return {};
  const double least = std::pow(10., -floor_db / 10);
  return 10 * (power / *most).array().max(least).log10();
}

}  // namespace

double PowerSpectrum::power(double low_hz, double high_hz) const {
  return spectral_moment(*this, 0, low_hz, high_hz);
}

PowerSpectrum whole_spectrum(const Eigen::Ref<const Eigen::VectorXd>& samples, int sample_rate,
                             SoundWindow window) {
  require_sound(samples, sample_rate);
  const Eigen::Index n = samples.size();
  const Eigen::Index padded = std::bit_ceil(
      static_cast<std::uint64_t>(std::max<Eigen::Index>({2 * n, sample_rate / 2, 8})));
  Periodogram periodogram(
      window == SoundWindow::hann ? hann_window(n) : Eigen::VectorXd::Ones(n).eval(), padded,
      sample_rate);
  return {static_cast<double>(sample_rate) / static_cast<double>(padded), periodogram(samples)};
}

PowerSpectrum welch_spectrum(const Eigen::Ref<const Eigen::VectorXd>& samples, int sample_rate,
                             int segment) {
  require_sound(samples, sample_rate);
  if (segment < 8) {
    throw Error("segment of " + std::to_string(segment) + " samples", "sound", "at least 8");
  }
  const Eigen::Index length = std::min<Eigen::Index>(segment, samples.size());
  const Eigen::Index hop = std::max<Eigen::Index>(1, length / 2);
  Periodogram periodogram(hann_window(length), segment, sample_rate);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(segment / 2 + 1);
  int segments = 0;
  for (Eigen::Index start = 0; start + length <= samples.size(); start += hop, ++segments) {
    sum += periodogram(samples.segment(start, length));
  }
  return {static_cast<double>(sample_rate) / segment, sum / segments};
}

std::optional<double> spectral_centroid(const PowerSpectrum& spectrum, double low_hz,
                                        double high_hz) {
  const double power = spectral_moment(spectrum, 0, low_hz, high_hz);
  if (!(power > 0)) return {};
  return spectral_moment(spectrum, 1, low_hz, high_hz) / power;
}

double third_octave_middle(int band) { return 1000 * std::pow(10., (band - 16) / 10.); }

std::optional<Eigen::VectorXd> third_octave_levels(const PowerSpectrum& spectrum, double floor_db) {
  Eigen::VectorXd power(kThirdOctaves);
  for (int band = 0; band < kThirdOctaves; ++band) {
    power(band) = spectrum.power(band_edge(band), band_edge(band + 1));
  }
  return relative_levels(power, floor_db);
}

std::optional<Eigen::VectorXd> third_octave_levels(const std::vector<SpectralLine>& lines,
                                                   double floor_db) {
  Eigen::VectorXd power = Eigen::VectorXd::Zero(kThirdOctaves);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto [frequency, line_power] = lines[i];
    if (!(frequency >= 0) || !(line_power >= 0) || !std::isfinite(frequency + line_power)) {
      throw Error(
          "power " + std::to_string(line_power) + " at " + std::to_string(frequency) + " Hz",
          "line " + std::to_string(i), "finite, not negative");
    }
    for (int band = 0; band < kThirdOctaves; ++band) {
      if (frequency >= band_edge(band) && frequency < band_edge(band + 1))
        power(band) += line_power;
    }
  }
  return relative_levels(power, floor_db);
}

double log_spectral_distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double floor_db) {
  if (a.size() != b.size()) {
    throw Error(std::to_string(a.size()) + " and " + std::to_string(b.size()) + " bands",
                "log-spectral distance", "equal numbers");
  }
  int count = 0;
  double sum = 0, squares = 0;
  for (Eigen::Index band = 0; band < a.size(); ++band) {
    if (std::max(a(band), b(band)) <= -floor_db) continue;
    const double difference = a(band) - b(band);
    ++count;
    sum += difference;
    squares += difference * difference;
  }
  if (count == 0) throw Error("no band is above the floor", "log-spectral distance");
  const double mean = sum / count;
  return std::sqrt(std::max(0., squares / count - mean * mean));
}

}  // namespace geoprior
