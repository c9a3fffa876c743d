#include "core/inputs/sound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace geoprior {
namespace {

/// sin(2π f t), and its negative in a second channel.
Sound sine(double frequency, int sample_rate, double seconds) {
  const auto count = static_cast<Eigen::Index>(seconds * sample_rate);
  Sound sound{sample_rate, Eigen::MatrixXd(count, 2)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / sample_rate;
    sound.samples(i, 0) = std::sin(2 * std::numbers::pi * frequency * t);
    sound.samples(i, 1) = -sound.samples(i, 0);
  }
  return sound;
}

/// Largest difference away from both ends, where the kernel reaches into the silence (64 periods of
/// the lower rate).
double inner_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, int margin) {
  return (a - b).middleRows(margin, a.rows() - 2 * margin).cwiseAbs().maxCoeff();
}

struct Rates {
  int from, to;
};

class Resampled : public ::testing::TestWithParam<Rates> {};

// The band-limited function through the samples of a sine is the sine: the same samples at the
// other rate are known. 1e-5 is the ripple of a kernel of 100 dB.
TEST_P(Resampled, SineIsTheSineAtTheOtherRate) {
  const auto [from, to] = GetParam();
  const double nyquist = 0.5 * std::min(from, to);
  for (const double part : {0.01, 0.25, 0.89}) {
    const Sound out = resampled(sine(part * nyquist, from, 0.2), to);
    EXPECT_EQ(out.sample_rate, to);
    const auto count = out.samples.rows();
    ASSERT_NEAR(static_cast<double>(count), 0.2 * to, 1);
    const Sound expected = sine(part * nyquist, to, 0.21);
    const int margin = 70 * to / std::min(from, to) + 1;
    EXPECT_LT(inner_difference(out.samples, expected.samples.topRows(count), margin), 2e-5)
        << part << " of the Nyquist frequency";
  }
}

class Downsampled : public Resampled {};

// What would fold back into the band is 100 dB down: 1e-5 of the amplitude.
TEST_P(Downsampled, ToneAboveTheNewNyquistFrequencyIsGone) {
  const auto [from, to] = GetParam();
  const double nyquist = 0.5 * to;
  for (const double frequency : {1.001 * nyquist, 0.5 * (nyquist + 0.5 * from), 0.499 * from}) {
    const Sound out = resampled(sine(frequency, from, 0.2), to);
    const Eigen::MatrixXd silence = Eigen::MatrixXd::Zero(out.samples.rows(), 2);
    EXPECT_LT(inner_difference(out.samples, silence, 70), 2e-5) << frequency << " Hz";
  }
}

// Every phase of the kernel sums to 1.
TEST(Resampling, KeepsAConstantToRoundOff) {
  const Sound ones{44100, Eigen::MatrixXd::Ones(4410, 1)};
  const Sound out = resampled(ones, 48000);
  EXPECT_LT(inner_difference(out.samples, Eigen::MatrixXd::Ones(4800, 1), 75), 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Rates, Resampled,
                         ::testing::Values(Rates{44100, 48000}, Rates{48000, 44100},
                                           Rates{16000, 48000}, Rates{96000, 44100},
                                           Rates{48000, 47111}, Rates{192000, 8000}));
INSTANTIATE_TEST_SUITE_P(Rates, Downsampled,
                         ::testing::Values(Rates{48000, 44100}, Rates{96000, 44100},
                                           Rates{192000, 8000}));

TEST(Resampling, ToTheSameRateChangesNothing) {
  const Sound sound = sine(440, 48000, 0.01);
  EXPECT_EQ(resampled(sound, 48000).samples, sound.samples);
}

TEST(Resampling, OfNoSamplesHasNone) {
  const Sound none{48000, Eigen::MatrixXd(0, 2)};
  EXPECT_EQ(resampled(none, 44100).samples.rows(), 0);
  EXPECT_EQ(resampled(none, 44100).samples.cols(), 2);
}

TEST(Resampling, RefusesRatesOfNoSound) {
  const Sound sound = sine(440, 48000, 0.01);
  EXPECT_THROW((void)resampled(sound, 0), Error);
  EXPECT_THROW((void)resampled(sound, -48000), Error);
  EXPECT_THROW((void)resampled(sound, 1000000), Error);
  EXPECT_THROW((void)resampled({7999, sound.samples}, 48000), Error);
}

}  // namespace
}  // namespace geoprior
