#include "metrics/sound/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "tests/metrics/sounds.h"

namespace geoprior {
namespace {

Eigen::VectorXd tone(double hz, Eigen::Index samples = kSoundRate) {
  return sine(samples, hz / kSoundRate);
}

/// Density c / f between 10 Hz and half the rate.
PowerSpectrum pink_spectrum() {
  PowerSpectrum pink{0.5, Eigen::VectorXd::Zero(48001)};
  for (Eigen::Index k = 20; k < pink.density.size(); ++k) {
    pink.density(k) = 1 / (0.5 * static_cast<double>(k));
  }
  return pink;
}

TEST(PowerSpectrum, IntegratesToTheMeanSquare) {
  const Eigen::VectorXd noise = white_noise(kSoundRate, 3);
  const PowerSpectrum whole = whole_spectrum(noise, kSoundRate, SoundWindow::none);
  EXPECT_NEAR(whole.power() / noise.squaredNorm() * kSoundRate, 1, 1e-12);  // Parseval
  // Of n / 2 independent bins, each with a spread of its own size.
  EXPECT_NEAR(welch_spectrum(noise, kSoundRate).power(), 1, 0.03);
  EXPECT_NEAR(whole_spectrum(noise, kSoundRate, SoundWindow::hann).power(), 1, 0.03);
  // A sine of amplitude 1 has mean square 1/2, wherever it lies between the bins.
  EXPECT_NEAR(welch_spectrum(tone(1003.7), kSoundRate).power(), 0.5, 1e-6);
  EXPECT_NEAR(whole_spectrum(tone(1003.7), kSoundRate, SoundWindow::hann).power(), 0.5, 1e-6);
}

TEST(PowerSpectrum, SharesTheBinsThatAreCut) {
  const PowerSpectrum flat{2, Eigen::VectorXd::Ones(11)};  // 0 ... 20 Hz
  EXPECT_DOUBLE_EQ(flat.power(), 20);
  EXPECT_DOUBLE_EQ(flat.power(3.25, 3.75), 0.5);
  EXPECT_DOUBLE_EQ(flat.power(0, 7.3) + flat.power(7.3, 11) + flat.power(11, 50), 20);
}

TEST(PowerSpectrum, ResolvesTwoTones) {
  const Eigen::VectorXd two = tone(440) + 0.5 * tone(1760);
  const PowerSpectrum spectrum = welch_spectrum(two, kSoundRate);
  EXPECT_NEAR(spectrum.power(400, 480), 0.5, 1e-4);
  EXPECT_NEAR(spectrum.power(1700, 1820), 0.125, 1e-4);
  EXPECT_LT(spectrum.power(500, 1600), 1e-6);
}

TEST(PowerSpectrum, OfAShortSoundIsThatOfOneSegment) {
  const Eigen::VectorXd noise = white_noise(700, 5);
  const PowerSpectrum one = welch_spectrum(noise, kSoundRate, 1024);
  EXPECT_EQ(one.density.size(), 513);
  const PowerSpectrum whole = whole_spectrum(noise, kSoundRate, SoundWindow::hann);
  EXPECT_NEAR(one.density(100), whole.density(100 * (whole.density.size() - 1) / 512),
              1e-12 * whole.density.maxCoeff());
}

TEST(SpectralCentroid, OfASineIsItsFrequency) {
  for (const double hz : {100., 440., 3333.3, 15000.}) {
    EXPECT_NEAR(*spectral_centroid(welch_spectrum(tone(hz), kSoundRate)), hz, 1e-3 * hz);
    EXPECT_NEAR(*spectral_centroid(whole_spectrum(tone(hz), kSoundRate, SoundWindow::hann)), hz,
                1e-3 * hz);
  }
}

TEST(SpectralCentroid, OfTwoTonesIsTheirMeanByPower) {
  const PowerSpectrum spectrum = welch_spectrum(tone(1000) + 2 * tone(4000), kSoundRate);
  EXPECT_NEAR(*spectral_centroid(spectrum), (1000 + 4 * 4000) / 5., 1);
}

TEST(SpectralCentroid, OfWhiteNoiseIsTheMiddleOfWhatIsHeard) {
  // Spread of the mean of n / 2 exponential weights over a width of 20 kHz: 20000 / sqrt(6 n).
  const PowerSpectrum spectrum = welch_spectrum(white_noise(4 * kSoundRate, 9), kSoundRate);
  EXPECT_NEAR(*spectral_centroid(spectrum), 10010, 60);
  EXPECT_NEAR(*spectral_centroid(spectrum, 2000, 4000), 3000, 60);
}

/// `sound_centroid`: by power, not magnitude, of the whole sound, and only of what is heard.
TEST(SpectralCentroid, OfAWholeSoundIsByPowerAndLeavesOutWhatLiesBelow20Hz) {
  const auto centroid = [](const Eigen::VectorXd& sound) {
    return *spectral_centroid(whole_spectrum(sound, kSoundRate, SoundWindow::none));
  };
  EXPECT_NEAR(centroid(tone(1000) + 2 * tone(4000)), 3400, 10);  // by magnitude: 3000
  EXPECT_NEAR(centroid(tone(10) + tone(1000)), 1000, 15);        // with all of it: 505
  Eigen::VectorXd click = Eigen::VectorXd::Zero(9000);
  click(4000) = 0.5;
  EXPECT_NEAR(centroid(click), 10010, 3);
}

TEST(SpectralCentroid, IsAbsentInSilence) {
  EXPECT_FALSE(spectral_centroid(welch_spectrum(Eigen::VectorXd::Zero(9000), kSoundRate)));
}

TEST(ThirdOctaves, HaveTheMiddlesOfTheStandard) {
  EXPECT_NEAR(third_octave_middle(0), 25.1189, 1e-4);
  EXPECT_DOUBLE_EQ(third_octave_middle(16), 1000);
  EXPECT_NEAR(third_octave_middle(28), 15848.93, 1e-2);
}

TEST(ThirdOctaves, OfAFlatDensityRiseByOneDecibelABand) {
  const PowerSpectrum flat{1.4, Eigen::VectorXd::Ones(17000)};
  const Eigen::VectorXd levels = *third_octave_levels(flat);
  for (int band = 0; band < kThirdOctaves; ++band) EXPECT_NEAR(levels(band), band - 28, 1e-9);
}

TEST(ThirdOctaves, OfWhiteNoiseRiseByOneDecibelABand) {
  const Eigen::VectorXd levels =
      *third_octave_levels(welch_spectrum(white_noise(20 * kSoundRate, 2), kSoundRate));
  // The band at 100 Hz is 23 Hz wide: 20 s of it have a spread of 4.34 / sqrt(20 x 23) = 0.2 dB.
  for (int band = 6; band < kThirdOctaves; ++band) {
    EXPECT_NEAR(levels(band) - levels(28), band - 28, 0.8) << band;
  }
}

TEST(ThirdOctaves, OfPinkNoiseAreLevel) {
  const Eigen::VectorXd levels = *third_octave_levels(pink_spectrum());
  for (int band = 0; band < kThirdOctaves; ++band) EXPECT_NEAR(levels(band), 0, 0.01) << band;
}

TEST(ThirdOctaves, AddUpToTheWholePower) {
  const PowerSpectrum spectrum = welch_spectrum(white_noise(kSoundRate, 7), kSoundRate);
  const double all = spectrum.power(1000 * std::pow(10., -1.65), 1000 * std::pow(10., 1.25));
  const Eigen::ArrayXd levels = *third_octave_levels(spectrum, 200);
  const double loudest = spectrum.power(1000 * std::pow(10., 1.15), 1000 * std::pow(10., 1.25));
  ASSERT_EQ(levels(28), 0);
  EXPECT_NEAR((levels * std::numbers::ln10 / 10).exp().sum() * loudest, all, 1e-12);
}

TEST(ThirdOctaves, OfASineAreAtTheFloorBesideIt) {
  const Eigen::VectorXd levels = *third_octave_levels(welch_spectrum(tone(1000), kSoundRate), 50);
  for (int band = 0; band < kThirdOctaves; ++band) {
    EXPECT_EQ(levels(band), band == 16 ? 0 : -50) << band;
  }
}

TEST(ThirdOctaves, OfLinesAreThoseOfTheirTones) {
  const std::vector<SpectralLine> lines{{210, 1}, {1000, 0.5}, {1050, 0.5}, {5000, 0.01}};
  const Eigen::VectorXd levels = *third_octave_levels(lines);
  EXPECT_NEAR(levels(16), 0, 1e-12);
  EXPECT_NEAR(levels(23), -20, 1e-12);
  const Eigen::VectorXd sound =
      std::sqrt(2.) * tone(210) + tone(1000) + tone(1050) + std::sqrt(0.02) * tone(5000);
  const Eigen::VectorXd heard =
      *third_octave_levels(whole_spectrum(sound, kSoundRate, SoundWindow::hann));
  EXPECT_LT(log_spectral_distance(levels, heard), 0.05);
}

TEST(ThirdOctaves, AreAbsentInSilence) {
  EXPECT_FALSE(third_octave_levels(PowerSpectrum{1, Eigen::VectorXd::Zero(9)}));
  EXPECT_FALSE(third_octave_levels(std::vector<SpectralLine>{}));
  EXPECT_FALSE(third_octave_levels(std::vector<SpectralLine>{{10, 1}}));  // below the bands
}

TEST(LogSpectralDistance, IsZeroUnderAnyGain) {
  const Eigen::VectorXd noise = white_noise(kSoundRate, 11);
  const auto levels = [](const Eigen::VectorXd& x) {
    return *third_octave_levels(welch_spectrum(x, kSoundRate));
  };
  const Eigen::VectorXd own = levels(noise);
  for (const double gain : {1e-4, 0.5, 30.}) {
    EXPECT_LT(log_spectral_distance(own, levels(gain * noise)), 1e-9);
  }
  EXPECT_LT(log_spectral_distance(own, own.array() + 3), 1e-12);
}

// 6 dB in half of the bands is 3 dB above and below their mean.
TEST(LogSpectralDistance, OfAShelfIsHalfItsHeight) {
  const Eigen::VectorXd flat = Eigen::VectorXd::Constant(28, -20);
  Eigen::VectorXd shelf = flat;
  shelf.head(14).array() += 6;
  EXPECT_NEAR(log_spectral_distance(flat, shelf), 3, 1e-12);
  EXPECT_NEAR(log_spectral_distance(shelf, flat), 3, 1e-12);
}

// White against pink: a ramp of 1 dB a band has the spread sqrt((29^2 - 1) / 12) = 8.367 dB.
TEST(LogSpectralDistance, OfWhiteFromPinkIsThatOfARamp) {
  const PowerSpectrum white{0.5, Eigen::VectorXd::Ones(48001)};
  EXPECT_NEAR(
      log_spectral_distance(*third_octave_levels(white), *third_octave_levels(pink_spectrum())),
      std::sqrt(840 / 12.), 0.01);
}

TEST(LogSpectralDistance, LeavesOutWhereBothAreAtTheFloor) {
  Eigen::VectorXd a = Eigen::VectorXd::Constant(29, -60), b = a;
  a.head(2) << 0, -6;
  b.head(2) << -6, 0;
  EXPECT_NEAR(log_spectral_distance(a, b), 6, 1e-12);
}

TEST(SoundSpectrum, NamesWhatIsWrong) {
  const Eigen::VectorXd sound = Eigen::VectorXd::Zero(10);
  Eigen::VectorXd broken = sound;
  broken(3) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(whole_spectrum(Eigen::VectorXd(), kSoundRate, SoundWindow::none), Error);
  EXPECT_THROW(whole_spectrum(broken, kSoundRate, SoundWindow::none), Error);
  EXPECT_THROW(welch_spectrum(sound, 0), Error);
  EXPECT_THROW(welch_spectrum(sound, kSoundRate, 4), Error);
  EXPECT_THROW(third_octave_levels(std::vector<SpectralLine>{{100, -1}}), Error);
  EXPECT_THROW(third_octave_levels(std::vector<SpectralLine>{{100, 1}}, 0), Error);
  EXPECT_THROW(log_spectral_distance(Eigen::VectorXd::Zero(3), Eigen::VectorXd::Zero(4)), Error);
  EXPECT_THROW(log_spectral_distance(Eigen::VectorXd(), Eigen::VectorXd()), Error);
}

}  // namespace
}  // namespace geoprior
