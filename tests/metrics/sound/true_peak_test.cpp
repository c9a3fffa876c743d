#include "metrics/sound/true_peak.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "tests/metrics/sounds.h"

namespace geoprior {
namespace {

/// A sine of so many cycles a sample that sets in and ends smoothly: its peak is 1.
Eigen::VectorXd swelling_sine(double cycles_a_sample, double phase) {
  constexpr int kSamples = 4000;
  const Eigen::ArrayXd envelope =
      Eigen::ArrayXd::LinSpaced(kSamples, 0, std::numbers::pi).sin().sqrt();
  return sine(kSamples, cycles_a_sample, phase).array() * envelope;
}

// The case of ITU-R BS.1770-5, annex 2, attachment 1: every sample of the sine lies 45 degrees off
// its peaks.
TEST(TruePeak, OfAQuarterRateSineIsThreeDecibelsAboveItsSamples) {
  const Eigen::VectorXd sound = swelling_sine(0.25, std::numbers::pi / 4);
  EXPECT_NEAR(decibels_full_scale(sound.cwiseAbs().maxCoeff()), -3.0103, 1e-3);
  EXPECT_NEAR(decibels_full_scale(true_peak(sound)), 0, 0.01);
}

TEST(TruePeak, OfSinesStaysWithinItsBound) {
  for (const double f : {0.01, 0.1, 0.1234, 0.2, 0.3, 0.3711, 0.4}) {
    for (int k = 0; k < 8; ++k) {
      const double peak = true_peak(swelling_sine(f, 0.1 * k));
      EXPECT_LT(peak, 1.001) << f;
      EXPECT_GT(peak, 0.999 * std::cos(std::numbers::pi * f / 8)) << f;
    }
  }
}

TEST(TruePeak, OfAnImpulseIsItself) {
  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(100);
  impulse(37) = -0.5;
  EXPECT_DOUBLE_EQ(true_peak(impulse), 0.5);
  EXPECT_DOUBLE_EQ(true_peak(Eigen::VectorXd::Ones(1)), 1);
}

// + + - - is the sine of amplitude sqrt 2 at a quarter of the rate.
TEST(TruePeak, OfTheShortestFullScaleSquareIsRootTwo) {
  Eigen::VectorXd square(4000);
  for (Eigen::Index i = 0; i < square.size(); ++i) square(i) = i % 4 < 2 ? 1 : -1;
  const double peak = true_peak(square.segment(0, 4000));
  // Where it is cut off at both ends it overshoots a little more.
  EXPECT_GT(peak, std::numbers::sqrt2 * 0.999);
  square.array() *= Eigen::ArrayXd::LinSpaced(4000, 0, std::numbers::pi).sin().sqrt();
  EXPECT_NEAR(decibels_full_scale(true_peak(square)), 3.0103, 0.01);
}

// Half a sample after a step from -1 to 1 the sinc series is 4 / pi: 1 = 2/pi + 1/2 + ... in pairs.
TEST(TruePeak, OfAFullScaleSquareIsNotBelowItsOvershoot) {
  Eigen::VectorXd square(4000);
  for (Eigen::Index i = 0; i < square.size(); ++i) square(i) = i % 400 < 200 ? 1 : -1;
  EXPECT_NEAR(true_peak(square), 4 / std::numbers::pi, 0.02);
}

TEST(TruePeak, ScalesWithTheSoundAndIsZeroOfSilence) {
  const Eigen::VectorXd noise = white_noise(1000, 1);
  EXPECT_NEAR(true_peak(0.25 * noise), 0.25 * true_peak(noise), 1e-15);
  EXPECT_GE(true_peak(noise), noise.cwiseAbs().maxCoeff());
  EXPECT_EQ(true_peak(Eigen::VectorXd()), 0);
  EXPECT_EQ(true_peak(Eigen::VectorXd::Zero(10)), 0);
  EXPECT_EQ(decibels_full_scale(0), -std::numeric_limits<double>::infinity());
}

TEST(TruePeak, NamesASampleThatIsNotFinite) {
  Eigen::VectorXd sound = Eigen::VectorXd::Zero(10);
  sound(7) = std::nan("");
  try {
    true_peak(sound);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "sample 7: it is not finite");
  }
}

}  // namespace
}  // namespace geoprior
