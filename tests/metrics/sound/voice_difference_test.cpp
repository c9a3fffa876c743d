#include "metrics/sound/voice_difference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/metrics/sounds.h"

namespace geoprior {
namespace {

/// Noise that falls by e within tau seconds.
Eigen::VectorXd rattle(double tau) {
  return white_noise(kSoundRate, 3).cwiseProduct(exponential_decay(kSoundRate, tau * kSoundRate));
}

TEST(VoiceDifference, OfASoundTimesAnyGainIsNone) {
  const Eigen::VectorXd sound = rattle(0.1);
  const auto same = voice_difference(0.01 * sound, sound, kSoundRate, 15000);
  ASSERT_TRUE(same);
  EXPECT_NEAR(same->distance_db, 0, 1e-9);
  EXPECT_NEAR(same->decay.value(), 0, 1e-9);
}

TEST(VoiceDifference, OfASoundThatRingsTwiceAsLongIsOneDoubling) {
  const auto longer = voice_difference(rattle(0.2), rattle(0.1), kSoundRate, 15000);
  ASSERT_TRUE(longer);
  EXPECT_NEAR(longer->decay.value(), 1, 0.05);
}

TEST(VoiceDifference, IsBlindAboveWhereTheReferenceIsKnown) {
  // Two tones: the second, at 8 kHz, lies above what is known.
  const Eigen::VectorXd low = sine(kSoundRate, 500.0 / kSoundRate)
                                  .cwiseProduct(exponential_decay(kSoundRate, 0.05 * kSoundRate)),
                        high = sine(kSoundRate, 8000.0 / kSoundRate)
                                   .cwiseProduct(exponential_decay(kSoundRate, 0.05 * kSoundRate));
  const double below = voice_difference(low + high, low, kSoundRate, 3000)->distance_db,
               above = voice_difference(low + high, low, kSoundRate, 15000)->distance_db;
  EXPECT_LT(below, 0.5);
  EXPECT_GT(above, 5);
}

TEST(VoiceDifference, OfSilenceIsThatOfBandsAtTheFloor) {
  // Noise of a level spectrum lies (x - x_max) dB under its loudest band, 1 dB a band: against
  // bands all at the floor the standard deviation of an arithmetic sequence.
  const auto silent =
      voice_difference(Eigen::VectorXd::Zero(kSoundRate), rattle(0.1), kSoundRate, 15000);
  ASSERT_TRUE(silent);
  const int bands = 22;  // about 100 Hz … 12.6 kHz
  EXPECT_NEAR(silent->distance_db, std::sqrt((bands * bands - 1) / 12.0), 0.5);
  EXPECT_NEAR(silent->decay.value(), 10, 1e-12);
  EXPECT_EQ(voice_difference({}, rattle(0.1), kSoundRate, 15000)->decay, 10);
}

TEST(VoiceDifference, IsAbsentWhereNothingIsKnown) {
  const Eigen::VectorXd sound = rattle(0.1);
  EXPECT_FALSE(voice_difference(sound, Eigen::VectorXd::Zero(kSoundRate), kSoundRate, 15000));
  EXPECT_FALSE(voice_difference(sound, {}, kSoundRate, 15000));
  EXPECT_FALSE(voice_difference(sound, sound, kSoundRate, 140));         // two bands
  EXPECT_FALSE(voice_difference(sound, sound, kSoundRate, 300)->decay);  // no whole octave
}

}  // namespace
}  // namespace geoprior
