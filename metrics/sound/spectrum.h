#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

namespace geoprior {

/// @throws Error  on a sample that is not finite (names it)
void require_finite_samples(const Eigen::Ref<const Eigen::VectorXd>& samples);

/// One-sided density of power over frequency. The density of bin k holds from (k - 1/2) to
/// (k + 1/2) steps, within 0 and half the sample rate; its integral is the mean square of the sound
/// (full scale = 1), by Parseval's identity.
struct PowerSpectrum {
  double step_hz = 0;
  Eigen::VectorXd density;  ///< full scale^2 / Hz, of k = 0 … half the padded length

  /// Integral of the density from `low_hz` to `high_hz`, with a share of the bins that they cut.
  [[nodiscard]] double power(double low_hz = 0,
                             double high_hz = std::numeric_limits<double>::infinity()) const;
};

/// What a sound is multiplied by before it is transformed.
enum class SoundWindow {
  hann,  ///< of a part of a longer sound: side lobes fall by 18 dB an octave
  none,  ///< of a struck sound from its onset until it has died away, whose onset Hann would take
};

/// Spectrum of the whole sound at once, in steps of at most 2 Hz: zeros are appended up to a power
/// of two that is at least twice the sound and half the sample rate. Padding interpolates; what is
/// resolved is the inverse of the sound's length.
/// @param samples      mono, full scale = 1
/// @param sample_rate  Hz
/// @throws Error  on no samples, one that is not finite (names it), or a rate below 1
PowerSpectrum whole_spectrum(const Eigen::Ref<const Eigen::VectorXd>& samples, int sample_rate,
                             SoundWindow window);

/// Mean of the spectra of segments under a Hann window, each half over the one before (Welch 1967):
/// the spectrum of a sound that goes on. The samples at the end that fill no segment are left out;
/// a sound shorter than a segment is one.
/// @param segment  samples; a power of two is fastest
/// @throws Error   as `whole_spectrum`, and on a segment below 8
PowerSpectrum welch_spectrum(const Eigen::Ref<const Eigen::VectorXd>& samples, int sample_rate,
                             int segment = 8192);

/// Mean frequency by power, in Hz, of what lies between two frequencies (those that are heard);
/// absent when there is no power.
std::optional<double> spectral_centroid(const PowerSpectrum& spectrum, double low_hz = 20,
                                        double high_hz = 20000);

/// A partial: a mode of a plate, a tone.
struct SpectralLine {
  double frequency_hz = 0;
  double power = 0;  ///< of any unit, not negative
};

/// Third-octave bands x = -16 … 12 of IEC 61260-1:2014, base 10: middles 1000 x 10^(x / 10) Hz
/// (nominally 25 Hz … 16 kHz), edges a factor of 10^(1/20) below and above.
inline constexpr int kThirdOctaves = 29;
/// @param band  0 … 28
double third_octave_middle(int band);

/// Power in each third-octave band as a level in dB below the loudest: 0 there, nowhere under
/// -`floor_db`. Bands share the bins they cut, so that their powers add up to the whole between
/// 22.4 Hz and 17.8 kHz. White noise rises by 1 dB a band, pink noise is level. Absent when no band
/// has power.
/// @throws Error  on a floor that is not positive
std::optional<Eigen::VectorXd> third_octave_levels(const PowerSpectrum& spectrum,
                                                   double floor_db = 60);
/// The same of lines; one on an edge counts above it.
/// @throws Error  on a line whose power or frequency is negative or not finite (names it)
std::optional<Eigen::VectorXd> third_octave_levels(const std::vector<SpectralLine>& lines,
                                                   double floor_db = 60);

/// Log-spectral distance in dB: standard deviation over the bands of the difference of levels,
/// which is the RMS difference once the gain is chosen for which it is least. 0 for a sound times
/// any gain; blind to all that happens within a band, and to phase. Bands in which both lie at
/// -`floor_db` or below are left out: nothing is known there.
/// @param a, b      levels of the same bands (dB), as of `third_octave_levels`
/// @param floor_db  that of both
/// @throws Error  on unequal numbers of bands, or no band above the floor
double log_spectral_distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                             double floor_db = 60);

}  // namespace geoprior
