#include "metrics/volume/wave_modes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"

namespace geoprior {
namespace {

struct Wave {
  int m, n;
  double amplitude, phase;
};

/// Heights of travelling waves a cos(k x - w t + phase), and their rates.
Eigen::MatrixXd heights(const std::vector<Wave>& waves, const WavePatch& patch, double t,
                        double slower = 1, bool rate = false) {
  constexpr int kSamples = 16;
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(kSamples, kSamples);
  for (const Wave& wave : waves) {
    const Eigen::Vector2d k(2 * std::numbers::pi * wave.m / patch.size_x,
                            2 * std::numbers::pi * wave.n / patch.size_y);
    const double w =
        slower * std::sqrt(patch.gravity * k.norm() * std::tanh(k.norm() * patch.depth));
    for (int i = 0; i < kSamples; ++i) {
      for (int j = 0; j < kSamples; ++j) {
        const double angle = k.x() * patch.size_x * i / kSamples +
                             k.y() * patch.size_y * j / kSamples - w * t + wave.phase;
        h(i, j) += rate ? wave.amplitude * w * std::sin(angle) : wave.amplitude * std::cos(angle);
      }
    }
  }
  return h;
}

const std::vector<Wave> kWaves{{1, 0, 1, 0.3}, {2, 3, 0.5, 1.1}, {-4, 1, 0.2, 2}, {0, -5, 0.1, 4}};

TEST(FourierModes, OfOneWaveAreHalfItsAmplitude) {
  const WavePatch patch{10, 10};
  const Eigen::MatrixXcd modes = fourier_modes(heights({{3, 1, 2, 0}}, patch, 0));
  EXPECT_NEAR(std::abs(modes(3, 1)), 1, 1e-14);
  EXPECT_NEAR(std::abs(modes(13, 15)), 1, 1e-14);
  EXPECT_NEAR(modes.cwiseAbs2().sum(), 2, 1e-13);  // Parseval: mean square of 2 cos
}

TEST(DispersionError, VanishesForWavesThatObeyTheRelation) {
  const WavePatch patch{10, 14, 9.81, 0.8};
  const auto at = [&](double t) { return fourier_modes(heights(kWaves, patch, t)); };
  const DispersionError error = dispersion_error(at(0.9), at(1), at(1.1), 0.1, patch);
  EXPECT_EQ(error.modes, 8);  // four waves and their conjugates
  EXPECT_LT(error.max, 1e-12);
}

TEST(DispersionError, IsTheFactorByWhichWavesAreTooSlow) {
  const WavePatch patch{10, 14, 9.81, 0.8};
  const auto at = [&](double t) { return fourier_modes(heights(kWaves, patch, t, 0.9)); };
  const DispersionError error = dispersion_error(at(0.9), at(1), at(1.1), 0.1, patch);
  EXPECT_NEAR(error.max, 0.1, 1e-12);
  EXPECT_NEAR(error.median, 0.1, 1e-12);
}

TEST(ShareRunningAlong, TellsDownwindFromUpwind) {
  const WavePatch patch{10, 14, 9.81, 100};
  const std::vector<Wave> downwind{{1, 0, 1, 0.3}, {2, 3, 0.5, 1.1}};
  const std::vector<Wave> mixed{{1, 0, 1, 0.3}, {-2, 1, 1, 1.1}};
  const auto share = [&](const std::vector<Wave>& waves) {
    return share_running_along(fourier_modes(heights(waves, patch, 2)),
                               fourier_modes(heights(waves, patch, 2, 1, true)), {1, 0}, patch);
  };
  EXPECT_NEAR(share(downwind), 1, 1e-12);
  EXPECT_NEAR(share(mixed), 0.5, 1e-12);
}

TEST(Moments, OfGaussianNumbers) {
  RandomStream random(3, "moments");
  Eigen::VectorXd values(200000);
  for (double& v : values) v = 2 + 0.5 * random.normal();
  const Moments m = moments(values);
  // Standard errors: sigma / sqrt(n) = 1e-3, variance 8e-4, kurtosis sqrt(24 / n) = 0.011; times 4.
  EXPECT_NEAR(m.mean, 2, 5e-3);
  EXPECT_NEAR(m.variance, 0.25, 4e-3);
  EXPECT_NEAR(m.kurtosis, 3, 0.05);
}

}  // namespace
}  // namespace geoprior
