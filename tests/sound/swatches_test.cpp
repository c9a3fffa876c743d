#include "experiments/sound/scene/swatches.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "experiments/sound/measures.h"
#include "models/sound/events/detector.h"
#include "models/sound/process.h"
#include "testbed/formats/wav_file.h"

namespace geoprior::sound {
namespace {

TEST(Swatches, EachIsOneFlapWithItsLengths) {
  SwatchOptions options;
  options.rulings = {0.02, 0.04};
  options.widths = {0.03};
  Sheet sheet;
  const auto swatches = make_swatches(options, sheet);
  DetectionOptions detection;
  detection.spacing = detection.radius = 2.5e-3;
  SoundDetector detector(sheet, detection);
  RunContext context;
  std::vector<SoundEvent> events;
  for (int i = 0; i < swatches->frame_count(); ++i) {
    for (const SoundEvent& e : detector.push(swatches->snapshot(i), context)) events.push_back(e);
  }
  for (const SoundEvent& e : detector.finish(context)) events.push_back(e);
  ASSERT_EQ(events.size(), 6u);  // two lengths, three supports
  for (int i = 0; i < std::ssize(events); ++i) {
    const double ruling = i % 2 == 0 ? 0.02 : 0.04, width = 0.03;
    EXPECT_EQ(events[i].kind, SoundKind::flap);
    EXPECT_NEAR(events[i].time, 0.25 * (i + 1), 1e-3);
    EXPECT_NEAR(events[i].area, ruling * width, 1e-9);
    EXPECT_NEAR(events[i].ruling_length, ruling, 2.5e-3);
    // Free all around, or clamped along one ruling; corners of the clamp are held, too.
    const bool clamped = i / 2 == 1;
    EXPECT_NEAR(events[i].free_border, clamped ? ruling + 2 * width : 2 * (ruling + width),
                clamped ? 6e-3 : 1e-9);
  }
}

TEST(Swatches, RefuseWhatCannotBeCut) {
  Sheet sheet;
  SwatchOptions options;
  options.widths = {};
  EXPECT_THROW(make_swatches(options, sheet), Error);
  options.widths = {0.03, -1};
  EXPECT_THROW(make_swatches(options, sheet), Error);
  options.widths = {0.03};
  options.snap = options.interval;
  EXPECT_THROW(make_swatches(options, sheet), Error);
}

/// A decaying sine, as the only sound of an event.
FramesInMemory recorded(double frequency, double gain, double time,
                        const FrameSequence* reference) {
  Sound sound{48000, Eigen::MatrixXd::Zero(24000, 1)};
  for (Eigen::Index i = 0; i < 24000; ++i) {
    const double t = static_cast<double>(i) / 48000;
    sound.samples(i, 0) = gain * std::exp(-30 * t) * std::sin(2 * 3.14159265 * frequency * t);
  }
  Event event;
  event.kind = "flap";
  event.time_s = time;
  event.numbers = {{"voice_start_s", 0}, {"voice_length_s", 0.5}, {"resolved_hz", 4000}};
  return FramesInMemory({Frame{}}, {event}, {{"voices.wav", wav_bytes(sound)}}, reference);
}

TEST(VoiceDistance, IsNothingForTheSameSoundAtAnyGainAndGrowsWithTheInterval) {
  const FramesInMemory reference = recorded(500, 0.8, 0.1, nullptr);
  const auto distance = [&](double frequency, double gain) {
    return voice_distance(recorded(frequency, gain, 0.1, &reference))->median;
  };
  EXPECT_NEAR(distance(500, 0.2), 0, 0.01);
  EXPECT_GT(distance(800, 0.8), 5);
  EXPECT_GT(distance(2000, 0.8), distance(800, 0.8));
  EXPECT_NEAR(*voice_distance(recorded(500, 0.2, 0.1, &reference))->decay, 0, 0.01);
  EXPECT_FALSE(voice_distance(recorded(500, 0.8, 0.1, nullptr)));
  // Another event: nothing to compare.
  EXPECT_THROW(voice_distance(recorded(500, 0.8, 0.2, &reference)), Error);
}

}  // namespace
}  // namespace geoprior::sound
