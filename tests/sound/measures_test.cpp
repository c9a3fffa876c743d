#include "experiments/sound/measures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "testbed/formats/wav_file.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sound {
namespace {

Event a_snap(const std::string& kind, double time, double energy) {
  Event event;
  event.kind = kind;
  event.time_s = time;
  event.energy_J = energy;
  for (const char* name : {"area_m2", "ruling_length_m", "free_border_m", "latency_s"}) {
    event.numbers[name] = 0.01;
  }
  return event;
}

/// Two seconds of white noise, and events.
SoundMeasures measured(const std::vector<Event>& events) {
  constexpr int kNoiseRate = 48000;
  geoprior::Sound sound;
  sound.sample_rate = kNoiseRate;
  sound.samples.resize(2 * kNoiseRate, 1);
  RandomStream random(1, "noise");
  for (Eigen::Index i = 0; i < sound.samples.rows(); ++i) {
    sound.samples(i, 0) = random.uniform() - 0.5;
  }
  Frame frame;
  frame.parameter = 0;
  const FramesInMemory frames({frame}, events, {Artifact{"sound.wav", wav_bytes(sound)}});
  return sound_measures(frames).value();
}

TEST(SoundMeasures, CountsSnapsOfTenMicrojoulesAndMoreOnly) {
  const SoundMeasures m =
      measured({a_snap("flap", 0.2, 1e-5), a_snap("crac", 0.4, 3e-5), a_snap("crac", 0.6, 9.9e-6),
                a_snap("friction", 0.8, 1), a_snap("tear", 1.0, 1)});
  EXPECT_EQ(m.large, 2);
  EXPECT_NEAR(m.large_energy, 4e-5, 1e-12);
}

TEST(SoundMeasures, SnapsAreCountedInBinsOfHalfADecade) {
  const SoundMeasures m =
      measured({a_snap("flap", 0.2, 1e-5), a_snap("crac", 0.3, 3.1e-5), a_snap("crac", 0.4, 3.2e-5),
                a_snap("crac", 0.6, 9.9e-6), a_snap("crac", 0.7, 1e-6), a_snap("flap", 0.9, 9.9e-7),
                a_snap("crac", 1.1, 1), a_snap("friction", 1.3, 1)});
  EXPECT_EQ(m.by_energy, (std::array<int, 7>{1, 1, 2, 1, 0, 0, 1}));
  EXPECT_EQ(m.large, 2 + 1 + 0 + 0 + 1);
}

// Of white noise each octave has twice the power of the one below. A band of 88 Hz that is heard
// for two seconds has some 350 independent values: a standard deviation of a third of a dB.
TEST(SoundMeasures, OctavesOfWhiteNoiseRiseByThreeDecibels) {
  const SoundMeasures m = measured({});
  ASSERT_EQ(m.octaves.size(), kOctaves.size());
  double sum = 0;
  for (std::size_t i = 0; i < kOctaves.size(); ++i) {
    EXPECT_NEAR(m.octaves[i] - m.octaves.back(), 3.0 * (static_cast<double>(i) - 7), 1) << i;
    sum += std::pow(10, m.octaves[i] / 10);
  }
  EXPECT_NEAR(sum, 1, 1e-9);
}

// Events may come from another program.
TEST(SoundMeasures, NameTheEventThatHasNoNumberThatIsRead) {
  Event snap = a_snap("crac", 0.5, 1e-5);
  snap.numbers.erase("free_border_m");
  EXPECT_THAT(test::error_of([&] {
                (void)measured({a_snap("flap", 0.2, 1e-5), snap});
              }),
              ::testing::AllOf(::testing::HasSubstr("the crac at 0.5"),
                               ::testing::HasSubstr("'free_border_m'")));
}

}  // namespace
}  // namespace geoprior::sound
