#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "baselines/sound/clicks.h"
#include "baselines/sound/modal/modal.h"
#include "baselines/sound/random_sounds.h"
#include "core/error.h"
#include "core/parallel.h"
#include "metrics/sound/spectrum.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/sound/process.h"
#include "models/sound/resonators/panel.h"
#include "models/sound/voices/bank.h"
#include "models/sound/voices/mixer.h"
#include "solvers/sound/sound.h"
#include "tests/paper/meshes.h"
#include "tests/support/recording.h"

namespace geoprior::sound {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSoundSpeed = 343;

/// Mono, without wall, full scale 1 Pa, one metre beside the origin.
MixOptions plain_mix() {
  MixOptions options;
  options.stereo = false;
  options.wall = false;
  options.listener = {1, 0, 0};
  options.full_scale = 1;
  return options;
}

std::vector<float> sine(double frequency, int count) {
  std::vector<float> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back(static_cast<float>(0.1 * std::sin(2 * kPi * frequency * i / 48000)));
  }
  return samples;
}

TEST(SoundMixer, SoundArrivesAfterItsWayAsOneOverTheDistance) {
  const std::vector<float> samples = sine(1000, 4800);
  for (const double distance : {1.0, 2.5}) {
    Voice voice{0.02, {1 - distance, 0, 0}, samples};
    const Mix result = mix({voice}, 0.2, plain_mix());
    for (Eigen::Index i = 2000; i < 4000; ++i) {
      const double since = static_cast<double>(i) / 48000 - 0.02 - distance / kSoundSpeed;
      EXPECT_NEAR(result.samples(i, 0), 0.1 / distance * std::sin(2 * kPi * 1000 * since), 2e-5);
    }
    EXPECT_EQ(result.samples.topRows(960).cwiseAbs().maxCoeff(), 0);
  }
}

TEST(SoundMixer, AWallIsAnImage) {
  const std::vector<float> samples = sine(1000, 4800);
  MixOptions options = plain_mix();
  options.wall = true;
  options.wall_point = {0, 0, -0.5};
  options.reflection = 0.6;
  const Mix with = mix({{0.02, {0, 0, 0}, samples}}, 0.2, options);
  options.wall = false;
  const Mix direct =
      mix({{0.02, {0, 0, 0}, samples}, {0.02, {0, 0, -1}, samples, 48000, 0.6}}, 0.2, options);
  EXPECT_LT((with.samples - direct.samples).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(SoundMixer, NearerEarHearsEarlierAndLouder) {
  const std::vector<float> samples = sine(2000, 480);
  MixOptions options = plain_mix();
  options.stereo = true;
  options.listener = {0, -1, 0};
  const Mix result = mix({{0, {2, -1, 0}, samples}}, 0.1, options);
  ASSERT_EQ(result.samples.cols(), 2);
  EXPECT_NEAR(result.samples.col(1).norm() / result.samples.col(0).norm(), 2.09 / 1.91, 1e-3);
}

TEST(SoundMixer, LowersTheWholeToTheTruePeak) {
  // A sine at a quarter of the rate whose samples lie 45 degrees off its peaks.
  std::vector<float> samples;
  for (int i = 0; i < 4800; ++i) {
    samples.push_back(static_cast<float>(std::sin(kPi / 2 * i + kPi / 4)));
  }
  MixOptions options = plain_mix();
  const double delay = std::ceil(1 / kSoundSpeed * 48000) / 48000 - 1 / kSoundSpeed;
  const Mix result = mix({{delay, {0, 0, 0}, samples}}, 0.2, options);
  EXPECT_NEAR(result.true_peak, -1, 1e-9);
  EXPECT_NEAR(result.lowered, 1, 0.15);
  EXPECT_NEAR(20 * std::log10(result.samples.cwiseAbs().maxCoeff()), -1 - 3.01, 0.15);
}

TEST(SoundMixer, EnvelopeRepeatsALoop) {
  const std::vector<float> samples(48000, 0.1F);
  Voice voice{0, {0, 0, 0}, samples};
  voice.envelope = {{0.1, 0}, {0.2, 1}, {2.4, 1}, {2.5, 0}};
  const Mix result = mix({voice}, 3, plain_mix());
  const auto at = [&](double t) {
    return result.samples(std::lround((t + 1 / kSoundSpeed) * 48000), 0);
  };
  EXPECT_NEAR(at(0.15), 0.05, 1e-5);
  EXPECT_NEAR(at(1.7), 0.1, 1e-6);
  EXPECT_NEAR(at(2.45), 0.05, 1e-5);
  EXPECT_EQ(at(2.6), 0);
}

TEST(SoundMixer, RefusesWhatItCannotMix) {
  MixOptions options = plain_mix();
  options.sample_rate = 44101;
  EXPECT_THROW(mix({}, 1, options), Error);
  options = plain_mix();
  options.wall = true;
  options.wall_normal = {0, 0, 0};
  EXPECT_THROW(mix({}, 1, options), Error);
  const Mix silent = mix({}, 1, plain_mix());
  EXPECT_EQ(silent.samples.rows(), 48000);
  EXPECT_EQ(silent.samples.cwiseAbs().maxCoeff(), 0);
}

/// The bank that is used when none is asked for: made once for all that look at it.
const SoundBank& default_bank() {
  static const SoundBank bank = generate_bank({}, {}, 1);
  return bank;
}

BankOptions three_sizes() {
  BankOptions options;
  options.sizes = 3;
  return options;
}

TEST(SoundBank, HasTheSoundsOfItsGrid) {
  const SoundBank& bank = default_bank();
  EXPECT_EQ(bank.of(SoundKind::flap).size() + bank.of(SoundKind::crac).size(), 256u);
  EXPECT_EQ(bank.of(SoundKind::friction).size(), 64u);
  EXPECT_FALSE(bank.of(SoundKind::tear).empty());
  EXPECT_NO_THROW(require_valid(bank, "bank"));
}

TEST(SoundBank, IsTheSameAtAnyNumberOfThreads) {
  SoundBank one, two;
  with_threads(1, [&] { one = generate_bank({}, three_sizes(), 7); });
  with_threads(2, [&] { two = generate_bank({}, three_sizes(), 7); });
  EXPECT_EQ(checksum(one), checksum(two));
  EXPECT_NE(checksum(one), checksum(generate_bank({}, three_sizes(), 8)));
}

TEST(SoundBank, NearestSoundsAreNearInBothDescriptors) {
  const SoundBank& bank = default_bank();
  SoundEvent event;
  event.ruling_length = 0.05;
  event.free_border = 0.1;
  const std::vector<int> order = nearest_sounds(bank, event, SoundOptions::Descriptors::both);
  ASSERT_EQ(order.size(), 128u);
  const BankSound& first = bank.sounds[order[0]];
  EXPECT_LT(std::abs(std::log(first.ruling_length / 0.05)), 0.3);
  EXPECT_LT(std::abs(std::log(first.free_border / 0.1)), 0.45);
}

TEST(SoundBank, SoundsHavePanelsWhoseBorderTheyName) {
  const SoundBank& bank = default_bank();
  for (const SoundKind kind : {SoundKind::flap, SoundKind::crac}) {
    for (const int i : bank.of(kind)) {
      const BankSound& sound = bank.sounds[i];
      const double l = sound.ruling_length, c = sound.free_border, w = sound.width;
      EXPECT_GT(w, 0);
      if (w <= kLeastPanelWidth) continue;
      // Between creases, hanging on one, free, or with creases all around.
      bool known = false;
      for (const double border : {2 * w, w, l + 2 * w, 2 * (l + w)})
        known = known || std::abs(c - border) < 1e-9;
      for (const double aspect : {2 / 3.0, 1.5, 3.0})
        known = known || (c < l && std::abs(w - aspect * l) < 1e-9);
      EXPECT_TRUE(known) << l << " " << c << " " << w;
    }
  }
}

/// A sheet that snaps, with one handle at its edge.
std::shared_ptr<const SheetAnimation> snapping(const Sheet& sheet) {
  const ShellMesh mesh =
      paper::uniform_mesh(sheet.pattern, 400, paper::UniformLayout::delaunay, {}, 1);
  std::vector<SheetSnapshot> frames;
  for (int i = 0; i <= 40; ++i) {
    SheetSnapshot frame;
    frame.time = 0.01 * i;
    frame.mesh = mesh;
    frame.x = paper::meshes::rolled(mesh.pattern, 25 * std::cos(2 * kPi * 8 * frame.time + 0.1), 0);
    frames.push_back(std::move(frame));
  }
  return std::make_shared<StoredSheetAnimation>(std::move(frames), "snapping");
}

std::vector<std::byte> raw(const Eigen::MatrixXd& samples, int /*rate*/) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(samples.size()) * sizeof(double));
  if (!bytes.empty()) std::memcpy(bytes.data(), samples.data(), bytes.size());
  return bytes;
}

/// Played from a small bank of paper, made once.
std::unique_ptr<Process> a_process(const Sheet& sheet, const SoundOptions& options = {}) {
  static const SoundBank bank = generate_bank({}, three_sizes(), 1);
  return make_sound_process(sheet, snapping(sheet), options.stage,
                            bank_voices(bank, options, sheet.material), raw);
}

TEST(SoundProcess, RecordsEventsPicturesAndOneSound) {
  Sheet sheet;
  sheet.pattern = paper::rectangle_pattern(0.2, 0.3);
  test::Recording record;
  RunContext context;
  a_process(sheet)->run(record, context, {});
  ASSERT_EQ(record.frames.size(), 41u);
  EXPECT_EQ(record.events.size(), 6u);  // crosses zero 6 times in 0.4 s
  ASSERT_EQ(record.artifacts.size(), 1u);
  EXPECT_EQ(record.artifacts[0].name, "sound.wav");
  Eigen::Index points = 0, cells = 0;
  for (const Frame& frame : record.frames) {
    points += frame.require_part("events").points.rows();
    cells += frame.require_part("resonators").triangles.rows();
  }
  EXPECT_EQ(points, 6);
  EXPECT_GT(cells, 6 * 1000);
  for (const Event& e : record.events) {
    EXPECT_EQ(e.kind, "flap");
    EXPECT_GT(e.energy_J, 0);
    EXPECT_GE(e.numbers.at("sample"), 0);
    EXPECT_NEAR(e.numbers.at("ruling_length_m"), 0.3, 0.02);
  }
}

TEST(SoundProcess, PickedEventsAreHeardAlone) {
  Sheet sheet;
  sheet.pattern = paper::rectangle_pattern(0.2, 0.3);
  SoundOptions options;
  options.stage.picked = {2, 2};  // of six events the first and the third
  test::Recording record;
  RunContext context;
  a_process(sheet, options)->run(record, context, {});
  ASSERT_EQ(record.artifacts.size(), 2u);
  EXPECT_EQ(record.artifacts[1].name, "voices.wav");
  std::vector<double> starts;
  double end = 0;
  for (std::size_t i = 0; i < record.events.size(); ++i) {
    const auto& numbers = record.events[i].numbers;
    EXPECT_EQ(numbers.contains("voice_start_s"), i == 0 || i == 2);
    if (!numbers.contains("voice_start_s")) continue;
    starts.push_back(numbers.at("voice_start_s"));
    EXPECT_GE(starts.back(), end);
    end = starts.back() + numbers.at("voice_length_s");
  }
  const auto* samples = reinterpret_cast<const double*>(record.artifacts[1].bytes.data());
  const Eigen::Index count = record.artifacts[1].bytes.size() / sizeof(double);
  EXPECT_GE(static_cast<double>(count), end * 48000 - 1);
  for (const double start : starts) {
    const Eigen::Map<const Eigen::VectorXd> all(samples, count);
    EXPECT_NEAR(all.segment(std::lround(start * 48000), 4800).cwiseAbs().maxCoeff(), 0.9, 1e-12);
  }
}

std::unique_ptr<Process> a_modal_process(const Sheet& sheet) {
  ModalSoundOptions options;
  options.stage.picked = {2, 2};
  options.stage.detection.spacing = 0.01;
  options.most_modes = 6;
  options.most_vertices = 100;
  return make_sound_process(sheet, snapping(sheet), options.stage,
                            modal_voices(options, sheet.material), raw);
}

TEST(SoundProcess, ModalSoundsOfPickedEventsSurviveACheckpoint) {
  Sheet sheet;
  sheet.pattern = paper::rectangle_pattern(0.2, 0.3);
  RunContext context;
  test::Recording whole, rest;
  a_modal_process(sheet)->run(whole, context, {});
  a_modal_process(sheet)->run(rest, context, whole.checkpoints.at(25));
  ASSERT_EQ(rest.artifacts.size(), 2u);
  EXPECT_EQ(rest.artifacts[0].bytes, whole.artifacts[0].bytes);
  EXPECT_EQ(rest.artifacts[1].bytes, whole.artifacts[1].bytes);
  ASSERT_EQ(whole.events.size(), 6u);
  const auto& numbers = whole.events[2].numbers;
  EXPECT_EQ(numbers.at("modes"), 6);
  EXPECT_GT(numbers.at("radiated_share"), 0);
  EXPECT_LT(numbers.at("radiated_share"), 1);
}

TEST(SoundProcess, ResumesToTheSameSound) {
  Sheet sheet;
  sheet.pattern = paper::rectangle_pattern(0.2, 0.3);
  RunContext context;
  test::Recording whole, rest;
  a_process(sheet)->run(whole, context, {});
  a_process(sheet)->run(rest, context, whole.checkpoints.at(17));
  ASSERT_EQ(rest.artifacts.size(), 1u);
  EXPECT_EQ(rest.artifacts[0].bytes, whole.artifacts[0].bytes);
  EXPECT_EQ(rest.frames.size(), whole.frames.size() - 18);
}

TEST(SoundProcess, ABentResonatorIsPlayedHigher) {
  BankOptions options = three_sizes();
  options.flap_bow = 0;
  SoundOptions choice;
  choice.detune = 0;
  choice.nearest = 1;
  const PaperMaterial material;
  SoundBank bank = generate_bank(material, options, 1);
  // Held at both ends of its rulings.
  std::erase_if(bank.sounds, [](const BankSound& sound) {
    return sound.kind != SoundKind::flap || sound.root_along < 4.7;
  });
  const auto voices = bank_voices(bank, choice, material);
  SoundEvent event;
  event.ruling_length = 0.04;
  event.area = 0.04 * 0.06;
  const double flat = voices->voice(event, {}, {1, "test"}).voice.rate;
  event.curvature = 1.5;
  const double bent = voices->voice(event, {}, {1, "test"}).voice.rate;
  const auto pitch = [&](double bow) {
    return lowest_frequency({.length = 0.04, .width = 0.06, .bow = bow}, 4.73, 4.73, material);
  };
  EXPECT_NEAR(bent / flat, pitch(1.5) / pitch(0), 1e-3);
  EXPECT_GT(bent, 1.2 * flat);
  // A panel that nothing holds has no pitch to change.
  for (BankSound& sound : bank.sounds) sound.root_across = sound.root_along = 0;
  EXPECT_EQ(bank_voices(bank, choice, material)->voice(event, {}, {1, "test"}).voice.rate, 48000);
}

TEST(BlendedFriction, GoesFromOneLoopToTheNextWithTheSpeed) {
  SoundBank bank;
  for (const float level : {1.0f, 3.0f}) {
    BankSound& loop = bank.sounds.emplace_back();
    loop.kind = SoundKind::friction;
    loop.speed = level > 2 ? 0.4 : 0.1;
    loop.samples = Eigen::VectorXf::Constant(100, level);
  }
  const auto at = [&](double speed) {
    return blended_friction(bank, {0, 1}, {{0, speed, 0, 0}, {1, speed, 0, 0}})[500];
  };
  EXPECT_FLOAT_EQ(at(0.01), 1);
  EXPECT_FLOAT_EQ(at(0.1), 1);
  EXPECT_FLOAT_EQ(at(0.4), 3);
  EXPECT_FLOAT_EQ(at(5), 3);
  // Half of the way in the logarithm: half of each power.
  EXPECT_NEAR(at(0.2), std::sqrt(0.5) * 4, 1e-5);
  const Eigen::VectorXf faster =
      blended_friction(bank, {0, 1}, {{0, 0.1, 0, 0}, {0.5, 0.4, 0, 0}, {2, 0.4, 0, 0}});
  EXPECT_GE(faster.size(), 2 * bank.sample_rate);
  EXPECT_FLOAT_EQ(faster[0], 1);
  EXPECT_NEAR(
      faster[12240],  // it begins 5 ms before
      std::sqrt(1 - std::log(2.5) / std::log(4)) + 3 * std::sqrt(std::log(2.5) / std::log(4)),
      1e-4);
  EXPECT_FLOAT_EQ(faster[90000], 3);
  EXPECT_THROW(blended_friction(bank, {}, {{0, 0.1, 0, 0}}), Error);
  EXPECT_THROW(blended_friction(bank, {0}, {}), Error);
}

/// Of a click alone: share of its power from one frequency to another.
double click_share(const ClickOptions& options, double low, double high) {
  SoundEvent event;
  event.energy = 1e-5;
  const auto voices = click_voices(options);
  const EventVoice click = voices->voice(event, {}, {1, "test"});
  const Eigen::VectorXd samples =
      Eigen::Map<const Eigen::VectorXf>(click.voice.samples.data(), click.voice.samples.size())
          .cast<double>();
  const PowerSpectrum spectrum = whole_spectrum(samples, 48000, SoundWindow::none);
  return spectrum.power(low, high) / spectrum.power();
}

// A white sound has (24 - 4)/24 kHz of its power above 4 kHz; the trough takes a hundredth part.
TEST(Clicks, HoldEveryFrequencyAlikeAndNoConstantPressure) {
  EXPECT_NEAR(click_share({}, 4000, 24000), 20.0 / 24, 0.01);
  EXPECT_LT(click_share({}, 0, 20), 1e-5);
  // Octaves about 500 Hz, 2 kHz and 16 kHz: by what they are wide.
  for (const double middle : {500.0, 2000.0, 16000.0}) {
    const double low = middle / std::numbers::sqrt2;
    EXPECT_NEAR(click_share({}, low, 2 * low) / (low / 24000), 1, 0.02) << middle;
  }
  // Half of the amplitude at 1/length, in a band about it.
  ClickOptions options;
  for (const double length : {0.01, 0.005}) {
    options.length = length;
    const double f = 1 / length;
    EXPECT_NEAR(click_share(options, 0.99 * f, 1.01 * f) / (0.02 * f / 24000), 0.25, 0.03);
  }
}

// What the way to the ears, the wall and the interpolation between samples leave of it.
TEST(Clicks, AreHeardInTheMixWithoutConstantPressure) {
  Sheet sheet;
  sheet.pattern = paper::rectangle_pattern(0.2, 0.3);
  RunContext context;
  test::Recording record;
  make_sound_process(sheet, snapping(sheet), {}, click_voices({}), raw)->run(record, context, {});
  const auto* samples = reinterpret_cast<const double*>(record.artifacts[0].bytes.data());
  const Eigen::Index count = record.artifacts[0].bytes.size() / sizeof(double);
  const Eigen::Map<const Eigen::MatrixXd> stereo(samples, count / 2, 2);
  const PowerSpectrum spectrum = whole_spectrum(stereo.col(0), 48000, SoundWindow::none);
  EXPECT_LT(spectrum.power(0, 20), 1e-4 * spectrum.power());
  EXPECT_GT(spectrum.power(4000, 24000), 0.7 * spectrum.power());
  EXPECT_GT(spectrum.power(8000, 16000), 0.2 * spectrum.power());
}

}  // namespace
}  // namespace geoprior::sound
