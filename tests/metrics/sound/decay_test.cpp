#include "metrics/sound/decay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "tests/metrics/sounds.h"

namespace geoprior {
namespace {

/// A tone that falls by e within tau seconds.
Eigen::VectorXd struck(double hz, double tau) {
  return sine(2 * kSoundRate, hz / kSoundRate)
      .cwiseProduct(exponential_decay(2 * kSoundRate, tau * kSoundRate));
}

const BandDecay& loudest(const std::vector<BandDecay>& bands) {
  for (const BandDecay& band : bands) {
    if (band.level_db == 0) return band;
  }
  return bands.front();
}

TEST(OctaveDecays, AnExponentialFallsBySixtyDecibelsInItsReverberationTime) {
  for (const double hz : {251., 1000., 3981.}) {
    for (const double tau : {0.02, 0.05, 0.2}) {
      const auto bands = octave_decays(struck(hz, tau), kSoundRate, 20000);
      ASSERT_FALSE(bands.empty());
      EXPECT_NEAR(loudest(bands).middle_hz, hz, 0.01 * hz);
      // 10^-3 = exp(-T / tau)
      EXPECT_NEAR(loudest(bands).reverberation_s, 6.908 * tau, 0.03 * 6.908 * tau) << hz << tau;
    }
  }
}

TEST(OctaveDecays, BandsAreJudgedApart) {
  const auto bands = octave_decays(struck(251, 0.1) + struck(1995, 0.02), kSoundRate, 20000);
  const auto at = [&](double hz) {
    return std::find_if(
               bands.begin(), bands.end(),
               [&](const BandDecay& band) { return std::abs(band.middle_hz - hz) < 0.01 * hz; })
        ->reverberation_s;
  };
  EXPECT_NEAR(at(251), 0.691, 0.03);
  EXPECT_NEAR(at(1995), 0.138, 0.01);
  // Only octaves that end below what is known.
  EXPECT_EQ(octave_decays(white_noise(kSoundRate, 1), kSoundRate, 1500).size(), 4u);
  EXPECT_EQ(octave_decays(white_noise(kSoundRate, 1), kSoundRate, 100).size(), 0u);
}

TEST(OctaveDecays, AClickRingsAsLongAsTheFilter) {
  Eigen::VectorXd click = Eigen::VectorXd::Zero(1000);
  click[10] = 1;
  for (const BandDecay& band : octave_decays(click, kSoundRate, 20000))
    EXPECT_NEAR(band.reverberation_s, 10 / band.middle_hz, 0.5 / band.middle_hz);
}

TEST(DecayDifference, CountsDoublings) {
  const auto decays = [](double tau, double gain) {
    return octave_decays(gain * struck(1000, tau), kSoundRate, 20000);
  };
  EXPECT_NEAR(decay_difference(decays(0.05, 1), decays(0.05, 0.1)), 0, 1e-9);
  EXPECT_NEAR(decay_difference(decays(0.1, 1), decays(0.05, 1)), 1, 0.05);
  EXPECT_NEAR(decay_difference(decays(0.0125, 1), decays(0.05, 1)), 2, 0.1);
  EXPECT_EQ(decay_difference({}, decays(0.05, 1)), 10);
  // A tone that swells and fades has nothing two octaves above.
  const Eigen::ArrayXd t = (Eigen::ArrayXd::LinSpaced(kSoundRate, 0, 1) - 0.5) / 0.05;
  const Eigen::VectorXd soft = sine(kSoundRate, 1000. / kSoundRate).array() * (-t.square()).exp();
  EXPECT_EQ(decay_difference(octave_decays(soft, kSoundRate, 20000),
                             octave_decays(struck(3981, 0.05), kSoundRate, 20000), 10),
            10);
  EXPECT_THROW(decay_difference(decays(0.05, 1), {}), Error);
}

TEST(OctaveDecays, RefuseWhatIsNoSound) {
  EXPECT_THROW(octave_decays(Eigen::VectorXd(), kSoundRate, 1000), Error);
  EXPECT_THROW(octave_decays(Eigen::VectorXd::Ones(10), 10, 1000), Error);
  Eigen::VectorXd broken = Eigen::VectorXd::Ones(10);
  broken[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(octave_decays(broken, kSoundRate, 1000), Error);
}

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
  EXPECT_LT(below, 1.5);  // what the onset of the second tone spreads
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
  EXPECT_FALSE(voice_difference(sound, sound, kSoundRate, 140));  // two bands
}

}  // namespace
}  // namespace geoprior
