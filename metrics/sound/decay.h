#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace geoprior {

/// An octave band of a sound and how it dies away in it.
struct BandDecay {
  double middle_hz = 0;
  double level_db = 0;  ///< of its energy below that of the loudest band
  /// In which what is still to come of its energy falls by 60 dB (s): three times the way from -5
  /// to -25 dB (T20 of ISO 3382-1).
  double reverberation_s = 0;
};

/// Octave bands from 125 Hz (IEC 61260-1:2014, base 10: 1000 x 10^(3 x / 10) Hz) to the one that
/// ends below `highest_hz`, in order of frequency; those with less than 1e-6 of the loudest one's
/// energy, what filters leak, are left out.
///
/// Bands are cut out of the spectrum of the whole sound with raised-cosine flanks a quarter of an
/// octave wide, which rings by itself: below about 10 periods of the band's middle (80 ms
/// at 125 Hz, 10 ms at 1 kHz) all sounds look alike. What is still to come is integrated backward
/// (Schroeder 1965). A sound that is over before it has fallen by 25 dB is one that ends there.
/// @param samples  mono, from its onset until it has died away
/// @throws Error   on no samples, one that is not finite, or a sample rate below 1000 Hz
std::vector<BandDecay> octave_decays(const Eigen::Ref<const Eigen::VectorXd>& samples,
                                     int sample_rate, double highest_hz);

/// By how much reverberation times of two sounds differ in the bands in which `wanted` is less than
/// `range_db` below its loudest: the median of |log2(T / T')|, in doublings. A band that `heard`
/// has no energy in counts as 10. 0 for the same decay in all of them, whatever the levels.
/// @throws Error  without bands in `wanted`
double decay_difference(const std::vector<BandDecay>& heard, const std::vector<BandDecay>& wanted,
                        double range_db = 20);

/// How a struck sound differs from one that it should be like.
struct VoiceDifference {
  double distance_db = 0;  ///< `log_spectral_distance` of third octaves (metrics/sound/spectrum.h)
  /// `decay_difference` of octaves, in doublings; absent where `wanted` has
  /// no whole octave below `highest_hz`.
  std::optional<double> decay;
};

/// Over bands from the one about 100 Hz to the last that ends below `highest_hz`, of what is less
/// than 40 dB below the loudest of these. A silent sound is as far away as one of which every band
/// is at that floor. Blind to gain, to onsets and to phase.
///
/// Absent where `wanted` is silent or has fewer than three bands.
/// @param heard,wanted  mono, from the onset until they have died away
/// @param highest_hz    up to where `wanted` is known
/// @throws Error        as `whole_spectrum` and `octave_decays`
std::optional<VoiceDifference> voice_difference(const Eigen::VectorXd& heard,
                                                const Eigen::VectorXd& wanted, int sample_rate,
                                                double highest_hz);

}  // namespace geoprior
