#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/options.h"

namespace geoprior::sound {

/// Where the sound is heard, and how it is written down.
struct MixOptions {
  int sample_rate = 48000;
  bool stereo = true;
  std::array<double, 3> listener{0, -0.6, 0.4};
  std::array<double, 3> right{1, 0, 0};
  double ears = 0.18;
  bool wall = true;
  std::array<double, 3> wall_point{0, 0, -0.3};
  std::array<double, 3> wall_normal{0, 0, 1};
  double reflection = 0.5;
  double full_scale = 0.2;
  double highest_peak = -1;
};
void describe(OptionVisitor& v, MixOptions& options);

/// A sound to be mixed: pressure 1 m from where it is made.
struct Voice {
  double time = 0;                    ///< of its start (s)
  Eigen::Vector3d position{0, 0, 0};  ///< m
  std::span<const float> samples;
  double rate = 48000;  ///< of the samples, a change of pitch included (Hz)
  double gain = 1;
  /// Of a continuous sound: time (s) and gain on top of `gain`, linear between; the samples are
  /// repeated from the first time to the last. Empty: they sound once.
  std::vector<Eigen::Vector2d> envelope = {};
};

/// The samples of a voice that sounds once, as they are 1 m away without delay, at another rate.
Eigen::VectorXd heard_alone(const Voice& voice, int sample_rate);

/// What a mix came to.
struct Mix {
  Eigen::MatrixXd samples;  ///< one row a sample, one column a channel, full scale 1
  double true_peak = 0;     ///< of `samples` (dBFS); minus infinity for silence
  double lowered = 0;       ///< by which the whole was made quieter to stay under the peak (dB)
};

/// Adds up voices, sample accurate: every ear hears every voice, and its image in the wall, after
/// the way that sound takes at 343 m/s and weakened as one over the distance, which counts as 5 cm
/// at least. Samples between samples are cubic (Lagrange). Voices are added in the order given, on
/// one thread.
///
/// Where the true peak (8 times oversampled) would exceed `highest_peak`, the whole is lowered.
///
/// @param duration  of the result (s); what rings on is cut off
/// @throws Error    on another sample rate than 44100 or 48000, or a wall without normal
Mix mix(const std::vector<Voice>& voices, double duration, const MixOptions& options);

}  // namespace geoprior::sound
