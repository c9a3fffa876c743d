#pragma once

#include <Eigen/Core>

namespace geoprior::sound {

/// Share of its loudest moment at which what rings is over.
inline constexpr double kSilence = 1e-3;

/// A mode that rings: pressure `amplitude` sin(2 pi f t + phase) exp(-pi eta f t), eta the loss
/// factor.
struct RingingMode {
  double frequency = 0;  ///< Hz
  double amplitude = 0;  ///< Pa, or relative
  double phase = 0;      ///< rad
};

/// Adds the mode from a sample on, until it is over.
void add_ringing(const RingingMode& mode, double eta, int sample_rate, Eigen::Index start,
                 Eigen::Ref<Eigen::VectorXd> out);

/// How long a mode rings (s).
double ringing_time(double frequency, double eta);

/// Magnitude of the spectrum of a raised cosine of length tau (s) and area 1: 1 at f = 0. What a
/// step that takes tau leaves of a mode of the frequency f (Hz).
double pulse_spectrum(double f, double tau);

/// A raised cosine over `seconds` from a sample on: a sound sets in as long as the snap takes.
void fade_in(Eigen::Ref<Eigen::VectorXd> out, Eigen::Index start, double seconds, int sample_rate);
/// One over the last 20 ms: nothing breaks off.
void fade_out(Eigen::Ref<Eigen::VectorXd> out, int sample_rate);

}  // namespace geoprior::sound
