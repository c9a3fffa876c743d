#include "metrics/sound/bursts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "tests/metrics/sounds.h"

namespace geoprior {
namespace {

using State = SoundBurst::State;

Event event_at(double time_s, const std::string& kind = "crac") {
  Event event;
  event.time_s = time_s;
  event.kind = kind;
  return event;
}

/// A struck tone or noise, amplitude exp(-t / tau).
Eigen::VectorXd struck_tone(double hz, double tau_s) {
  const auto n = static_cast<Eigen::Index>(12 * tau_s * kSoundRate);
  return sine(n, hz / kSoundRate).cwiseProduct(exponential_decay(n, tau_s * kSoundRate));
}
Eigen::VectorXd struck_noise(double tau_s, std::uint64_t seed) {
  const auto n = static_cast<Eigen::Index>(12 * tau_s * kSoundRate);
  return white_noise(n, seed).cwiseProduct(exponential_decay(n, tau_s * kSoundRate));
}

void add_at(Eigen::VectorXd& sound, double time_s, const Eigen::VectorXd& burst) {
  const auto begin = static_cast<Eigen::Index>(std::lround(time_s * kSoundRate));
  const Eigen::Index n = std::min(burst.size(), sound.size() - begin);
  sound.segment(begin, n) += burst.head(n);
}

Eigen::VectorXd silence(double seconds) {
  return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(seconds * kSoundRate));
}

// Energy exp(-2 t / tau): from 1 % to 99 % of it, tau ln(99) / 2.
TEST(SoundBursts, OfStruckTonesLastAsTheirDecaySays) {
  for (const double hz : {200., 1000., 6000.}) {
    for (const double tau : {0.03, 0.1}) {
      Eigen::VectorXd sound = silence(2);
      add_at(sound, 0.25, 0.3 * struck_tone(hz, tau));
      const SoundBurst burst = sound_bursts(sound, kSoundRate, std::vector{event_at(0.25)}).front();
      ASSERT_EQ(burst.state, State::measured);
      EXPECT_NEAR(burst.duration_s, tau * std::log(99) / 2, 0.5 / hz);  // a lobe of the tone
      EXPECT_NEAR(burst.onset_s, 0.25 + 0.005 * tau, 0.5 / hz);
      // The skirts of the line, which is 1 / (2 pi tau) wide, reach up to 20 kHz.
      EXPECT_NEAR(burst.centroid_hz, hz, 0.01 * hz + 0.6 / tau);
      EXPECT_EQ(burst.kind, "crac");
    }
  }
}

TEST(SoundBursts, OfStruckNoiseLastAsTheirDecaySays) {
  double centroid = 0;
  for (int seed = 0; seed < 10; ++seed) {
    Eigen::VectorXd sound = silence(2);
    add_at(sound, 0.5, struck_noise(0.1, seed));
    const SoundBurst burst = sound_bursts(sound, kSoundRate, std::vector{event_at(0.5)}).front();
    ASSERT_EQ(burst.state, State::measured);
    // About tau / 2 of noise decides when the last per cent begins.
    EXPECT_NEAR(burst.duration_s / (0.1 * std::log(99) / 2), 1, 0.05) << seed;
    centroid += burst.centroid_hz / 10;
  }
  // 50 ms of 20 kHz are 1000 independent amplitudes: 20000 / sqrt(12 x 1000 x 10) = 58 Hz.
  EXPECT_NEAR(centroid, 10010, 180);
}

TEST(SoundBursts, OfFewMillisecondsAreNotLengthened) {
  Eigen::VectorXd sound = silence(0.5);
  add_at(sound, 0.1, struck_tone(8000, 0.001));
  const SoundBurst burst = sound_bursts(sound, kSoundRate, std::vector{event_at(0.1)}).front();
  ASSERT_EQ(burst.state, State::measured);
  EXPECT_NEAR(burst.duration_s, 0.001 * std::log(99) / 2, 1e-4);
}

TEST(SoundBursts, DoNotCountTheWayOfTheSound) {
  Eigen::VectorXd sound = silence(1);
  add_at(sound, 0.11, struck_tone(1000, 0.02));  // 3.4 m away
  const SoundBurst burst = sound_bursts(sound, kSoundRate, std::vector{event_at(0.1)}).front();
  ASSERT_EQ(burst.state, State::measured);
  EXPECT_NEAR(burst.onset_s, 0.11, 1e-3);
  EXPECT_NEAR(burst.duration_s, 0.02 * std::log(99) / 2, 1e-3);
}

TEST(SoundBursts, FiftyMillisecondsApartAreTwoWhenTheyAreShort) {
  Eigen::VectorXd sound = silence(1);
  add_at(sound, 0.2, struck_tone(3000, 0.006));
  add_at(sound, 0.25, struck_tone(1000, 0.003));
  const std::vector<Event> events{event_at(0.25, "flap"), event_at(0.2)};  // in any order
  const std::vector<SoundBurst> bursts = sound_bursts(sound, kSoundRate, events);
  ASSERT_EQ(bursts[0].state, State::measured);
  ASSERT_EQ(bursts[1].state, State::measured);
  EXPECT_EQ(bursts[0].kind, "flap");
  EXPECT_NEAR(bursts[0].duration_s, 0.003 * std::log(99) / 2, 6e-4);
  EXPECT_NEAR(bursts[1].duration_s, 0.006 * std::log(99) / 2, 3e-4);
  EXPECT_NEAR(bursts[0].centroid_hz, 1000, 150);
  EXPECT_NEAR(bursts[1].centroid_hz, 3000, 150);
}

// After 50 ms an amplitude of tau = 20 ms has fallen by 22 dB.
TEST(SoundBursts, FiftyMillisecondsApartOverlapWhenTheyAreLong) {
  Eigen::VectorXd sound = silence(1);
  add_at(sound, 0.2, struck_tone(3000, 0.02));
  Eigen::VectorXd louder = sound;
  add_at(sound, 0.25, struck_tone(1000, 0.02));
  add_at(louder, 0.25, 10 * struck_tone(1000, 0.02));
  const std::vector<Event> events{event_at(0.2), event_at(0.25)};
  const std::vector<SoundBurst> alike = sound_bursts(sound, kSoundRate, events);
  EXPECT_EQ(alike[0].state, State::overlapped);
  EXPECT_EQ(alike[1].state, State::overlapped);
  EXPECT_EQ(alike[1].duration_s, 0);
  const std::vector<SoundBurst> covering = sound_bursts(louder, kSoundRate, events);
  EXPECT_EQ(covering[0].state, State::overlapped);
  EXPECT_EQ(covering[1].state, State::measured);  // what it covers is 42 dB below it
}

TEST(SoundBursts, OfOneMomentOverlap) {
  Eigen::VectorXd sound = silence(1);
  add_at(sound, 0.2, struck_tone(3000, 0.02));
  const std::vector<Event> events{event_at(0.2), event_at(0.2), event_at(0.204)};
  for (const SoundBurst& burst : sound_bursts(sound, kSoundRate, events)) {
    EXPECT_EQ(burst.state, State::overlapped);
  }
}

TEST(SoundBursts, OfSilenceAreSilent) {
  const SoundBurst none =
      sound_bursts(silence(0.5), kSoundRate, std::vector{event_at(0.1)}).front();
  EXPECT_EQ(none.state, State::silent);
  EXPECT_EQ(none.peak_db, -std::numeric_limits<double>::infinity());
  // An amplitude of 2e-5 is below -90 dB.
  const Eigen::VectorXd faint = 2e-5 * struck_tone(1000, 0.02);
  EXPECT_EQ(sound_bursts(faint, kSoundRate, std::vector{event_at(0)}).front().state, State::silent);
  EXPECT_TRUE(sound_bursts(faint, kSoundRate, {}).empty());
}

TEST(SoundBursts, AreCutOffWhereTheSoundEnds) {
  const Eigen::VectorXd whole = struck_tone(1000, 0.1);
  const std::vector<Event> events{event_at(0)};
  EXPECT_EQ(sound_bursts(whole, kSoundRate, events).front().state, State::measured);
  EXPECT_EQ(sound_bursts(whole.head(kSoundRate / 5), kSoundRate, events).front().state,
            State::cut_off);
  EXPECT_EQ(sound_bursts(whole, kSoundRate, events, {0.2}).front().state, State::cut_off);
}

TEST(SoundBursts, OverSteadyNoiseAreLeftOut) {
  Eigen::VectorXd sound = 0.05 * white_noise(kSoundRate, 4);
  add_at(sound, 0.3, struck_tone(1000, 0.02));
  const std::vector<Event> events{event_at(0.3)};
  EXPECT_EQ(sound_bursts(sound, kSoundRate, events).front().state, State::overlapped);
}

TEST(BurstStatistics, AreTheQuartilesOfEachKind) {
  std::vector<SoundBurst> bursts;
  for (const double d : {0.4, 0.1, 0.3, 0.2}) {
    bursts.push_back({State::measured, "flap", 0, -10, 0, d, 1000 * d});
  }
  bursts.push_back({State::silent, "flap"});
  bursts.push_back({State::overlapped, "crac"});
  bursts.push_back({State::cut_off, "crac"});
  const std::map<std::string, BurstStatistics> of = burst_statistics(bursts);
  EXPECT_EQ(of.at("flap").events, 5);
  EXPECT_EQ(of.at("flap").measured, 4);
  EXPECT_EQ(of.at("flap").silent, 1);
  EXPECT_EQ(of.at("flap").duration_s.lower, 0.1);
  EXPECT_EQ(of.at("flap").duration_s.median, 0.2);
  EXPECT_EQ(of.at("flap").duration_s.upper, 0.3);
  EXPECT_EQ(of.at("flap").centroid_hz.median, 200);
  EXPECT_EQ(of.at("crac").measured, 0);
  EXPECT_EQ(of.at("crac").overlapped, 1);
  EXPECT_EQ(of.at("crac").cut_off, 1);
  EXPECT_EQ(of.at("crac").duration_s.median, 0);
}

TEST(SoundBursts, NameWhatIsWrong) {
  Eigen::VectorXd sound = silence(0.1);
  const std::vector<Event> late{event_at(0), event_at(0.2)};
  try {
    sound_bursts(sound, kSoundRate, late);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("event 1: its time is 0.2"), std::string::npos);
  }
  EXPECT_THROW(sound_bursts(sound, 100, {}), Error);
  EXPECT_THROW(sound_bursts(sound, kSoundRate, {}, {0}), Error);
  sound(9) = std::nan("");
  EXPECT_THROW(sound_bursts(sound, kSoundRate, {}), Error);
}

}  // namespace
}  // namespace geoprior
