#include "metrics/sound/voice_difference.h"

#include <cmath>
#include <vector>

#include "metrics/sound/decay.h"
#include "metrics/sound/spectrum.h"

namespace geoprior {
namespace {

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
