#pragma once

#include <Eigen/Core>
#include <optional>

namespace geoprior {

/// How a struck sound differs from one that it should be like.
struct VoiceDifference {
  double distance_db = 0;  ///< `log_spectral_distance` of third octaves (metrics/sound/spectrum.h)
  /// `decay_difference` of octaves (metrics/sound/decay.h), in doublings; absent where `wanted` has
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
