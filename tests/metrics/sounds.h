#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/random.h"

namespace geoprior {

inline constexpr int kSoundRate = 48000;  ///< Hz, of the sounds of the tests

/// Gaussian white noise of RMS 1.
inline Eigen::VectorXd white_noise(Eigen::Index samples, std::uint64_t seed) {
  RandomStream random(seed, "white noise");
  Eigen::VectorXd noise(samples);
  for (double& x : noise) x = random.normal();
  return noise;
}

/// sin(2 pi f t + phase), f in cycles a sample.
inline Eigen::VectorXd sine(Eigen::Index samples, double cycles_a_sample, double phase = 0) {
  const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(samples, 0, static_cast<double>(samples - 1));
  return (2 * std::numbers::pi * cycles_a_sample * t + phase).sin();
}

/// exp(-t / tau), tau in samples.
inline Eigen::VectorXd exponential_decay(Eigen::Index samples, double tau) {
  return (Eigen::ArrayXd::LinSpaced(samples, 0, static_cast<double>(samples - 1)) / -tau).exp();
}

}  // namespace geoprior
