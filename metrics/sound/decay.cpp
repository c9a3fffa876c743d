#include "metrics/sound/decay.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <unsupported/Eigen/FFT>

#include "core/error.h"
#include "metrics/sound/spectrum.h"

namespace geoprior {
namespace {

constexpr int kLowestOctave = -3, kHighestOctave = 4;  // 125 Hz, 16 kHz
const double kHalfOctave = std::pow(10., 0.15);
constexpr double kNoEnergy = 10;  // doublings
constexpr double kLeak = -60;     // dB: of the loudest band

double middle_of(int octave) { return 1000 * std::pow(10., 0.3 * octave); }

/// Of a band-pass from low to high: 1 inside, a raised cosine over a quarter of an octave about
/// each edge.
double flank(double hz, double low, double high) {
  const auto rise = [](double octaves) {
    constexpr double kWidth = 0.25;
    const double x = std::clamp(octaves / kWidth + 0.5, 0., 1.);
    return (1 - std::cos(std::numbers::pi * x)) / 2;
  };
  return hz <= 0 ? 0 : rise(std::log2(hz / low)) * rise(std::log2(high / hz));
}

/// Three times the way from -5 to -25 dB of the energy that is still to come.
double reverberation_time(const Eigen::VectorXd& band, int sample_rate) {
  double left = band.squaredNorm();
  const double at_first = left * std::pow(10., -0.5), at_last = left * std::pow(10., -2.5);
  std::optional<Eigen::Index> first;
  for (Eigen::Index i = 0; i < band.size(); ++i) {
    left -= band[i] * band[i];
    if (!first && left <= at_first) first = i;
    if (left <= at_last) return 3 * static_cast<double>(i - *first) / sample_rate;
  }
  return 3 * static_cast<double>(band.size() - first.value_or(0)) / sample_rate;
}

constexpr double kFloor = 40;    // dB below the loudest band: not heard beside it
constexpr double kLowest = 100;  // Hz: the band about it is the lowest that is compared
constexpr int kFewestBands = 3;  // of a distance

bool is_silent(const Eigen::VectorXd& samples) {
  return samples.size() == 0 || !(samples.cwiseAbs().maxCoeff() > 0);
}

/// Levels of the bands from `kLowest` to below `highest`; absent for silence.
std::optional<Eigen::VectorXd> audible_levels(const Eigen::VectorXd& samples, int sample_rate,
                                              double highest) {
  if (is_silent(samples)) return {};
  PowerSpectrum spectrum = whole_spectrum(samples, sample_rate, SoundWindow::none);
  const double edge = std::pow(10, 0.05);
  int first = 0, last = kThirdOctaves;
  while (third_octave_middle(first) * edge < kLowest) ++first;
  while (last > first && third_octave_middle(last - 1) * edge > highest) --last;
  if (last == first) return {};
  // What lies beside is no yardstick for the loudest band.
  const double from = third_octave_middle(first) / edge,
               until = third_octave_middle(last - 1) * edge;
  for (Eigen::Index k = 0; k < spectrum.density.size(); ++k) {
    const double f = static_cast<double>(k) * spectrum.step_hz;
    if (f < from || f > until) spectrum.density[k] = 0;
  }
  const auto levels = third_octave_levels(spectrum, kFloor);
  if (!levels) return {};
  return levels->segment(first, last - first);
}

}  // namespace

std::vector<BandDecay> octave_decays(const Eigen::Ref<const Eigen::VectorXd>& samples,
                                     int sample_rate, double highest_hz) {
  if (sample_rate < 1000) {
    throw Error("sample rate " + std::to_string(sample_rate) + " Hz", "sound", "at least 1000");
  }
  if (samples.size() == 0) throw Error("no samples", "sound");
  require_finite_samples(samples);
  // Silence on both sides, for filters that ring before and after.
  const Eigen::Index margin = sample_rate / 4;
  const Eigen::Index padded =
      std::bit_ceil(static_cast<std::uint64_t>(samples.size() + 2 * margin));
  Eigen::VectorXd sound = Eigen::VectorXd::Zero(padded);
  sound.segment(margin, samples.size()) = samples;
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXcd modes(padded / 2 + 1), cut(padded / 2 + 1);
  transform.fwd(modes.data(), sound.data(), padded);
  std::vector<BandDecay> bands;
  double loudest = 0;
  std::vector<double> energies;
  for (int octave = kLowestOctave; octave <= kHighestOctave; ++octave) {
    const double low = middle_of(octave) / kHalfOctave, high = middle_of(octave) * kHalfOctave;
    if (high > std::min(highest_hz, sample_rate / 2.)) break;
    for (Eigen::Index k = 0; k < modes.size(); ++k) {
      const double hz = static_cast<double>(k) * sample_rate / static_cast<double>(padded);
      cut[k] = modes[k] * flank(hz, low, high);
    }
    transform.inv(sound.data(), cut.data(), padded);
    const double energy = sound.squaredNorm();
    if (!(energy > 0)) continue;
    bands.push_back({middle_of(octave), 0, reverberation_time(sound, sample_rate)});
    energies.push_back(energy);
    loudest = std::max(loudest, energy);
  }
  for (std::size_t i = 0; i < bands.size(); ++i)
    bands[i].level_db = 10 * std::log10(energies[i] / loudest);
  std::erase_if(bands, [](const BandDecay& band) { return band.level_db < kLeak; });
  return bands;
}

double decay_difference(const std::vector<BandDecay>& heard, const std::vector<BandDecay>& wanted,
                        double range_db) {
  std::vector<double> differences;
  for (const BandDecay& band : wanted) {
    if (band.level_db < -range_db || !(band.reverberation_s > 0)) continue;
    const auto same = std::find_if(heard.begin(), heard.end(), [&](const BandDecay& other) {
      return other.middle_hz == band.middle_hz && other.reverberation_s > 0;
    });
    const double doublings =
        same == heard.end() ? kNoEnergy : std::log2(same->reverberation_s / band.reverberation_s);
    differences.push_back(std::min(kNoEnergy, std::abs(doublings)));
  }
  if (differences.empty()) throw Error("has no band with energy", "sound that is wanted");
  std::sort(differences.begin(), differences.end());
  const std::size_t n = differences.size();
  return (differences[(n - 1) / 2] + differences[n / 2]) / 2;
}

std::optional<VoiceDifference> voice_difference(const Eigen::VectorXd& heard,
                                                const Eigen::VectorXd& wanted, int sample_rate,
                                                double highest_hz) {
  const auto levels = audible_levels(wanted, sample_rate, highest_hz);
  if (!levels || levels->size() < kFewestBands) return {};
  const auto own = audible_levels(heard, sample_rate, highest_hz);
  const Eigen::VectorXd floor = Eigen::VectorXd::Constant(levels->size(), -kFloor);
  VoiceDifference difference;
  difference.distance_db = log_spectral_distance(own ? *own : floor, *levels, kFloor);
  const auto rings = octave_decays(wanted, sample_rate, highest_hz);
  if (rings.empty()) return difference;
  difference.decay = decay_difference(
      heard.size() == 0 ? std::vector<BandDecay>{} : octave_decays(heard, sample_rate, highest_hz),
      rings);
  return difference;
}

}  // namespace geoprior
