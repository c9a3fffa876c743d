#pragma once

#include <Eigen/Core>
#include <string>

namespace geoprior {

/// A sound: a row a sample, a column a channel (mono: one; stereo: left, right), full scale ±1.
struct Sound {
  int sample_rate = 48000;  ///< Hz
  Eigen::MatrixXd samples;
};

/// Sample rates that are taken for those of a sound (Hz).
inline constexpr int kLeastSampleRate = 8000, kMostSampleRate = 192000;

/// The sound at another sample rate: the same length to within a sample, the same amplitudes.
///
/// Band-limited interpolation by a windowed sinc, one kernel for each phase of the ratio in lowest
/// terms: out(t) = Σ_j in(j) h(t − j), with h = sinc × Kaiser window of the parameter β for a
/// ripple of 100 dB, about 64 lobes on either side. Flat to 1e-5 up to 0.9 of the lower Nyquist
/// frequency; at that frequency and above attenuated by 100 dB, so that nothing folds back. What
/// lies between is rolled off. Before the first sample and after the last there is silence. Costs
/// about 128 products a sample when it goes up, by the ratio more when it goes down.
///
/// @param sample_rate  Hz
/// @throws Error  for a rate, the sound's or the wanted one, out of the limits above
/// Source: Smith and Gossett 1984, "A flexible sampling-rate conversion method"; Kaiser 1974 for
/// the window.
Sound resampled(const Sound& sound, int sample_rate);

/// @param where  what has the rate
/// @throws Error  unless it is within the limits above
void require_sample_rate(int sample_rate, const std::string& where);

}  // namespace geoprior
