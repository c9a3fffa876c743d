#include "solvers/sound/sound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "models/sound/resonators/panel.h"
#include "models/sound/voices/voice.h"

namespace geoprior::sound {
namespace {

using Descriptors = SoundOptions::Descriptors;

double distance(const BankSound& sound, const SoundEvent& event, Descriptors descriptors) {
  constexpr double kBorder = 5e-3;  // l_0 (m)
  if (event.kind == SoundKind::tear || event.kind == SoundKind::friction) return 0;
  const double ruling =
      std::log(std::max(event.ruling_length, 1e-9) / std::max(sound.ruling_length, 1e-9));
  const double border = std::log((event.free_border + kBorder) / (sound.free_border + kBorder));
  switch (descriptors) {
    case Descriptors::all: {
      const double width = event.area / std::max(event.ruling_length, 1e-9);
      const bool known = sound.width > 0 && width > 0;
      return std::hypot(ruling, border, known ? std::log(width / sound.width) : 0);
    }
    case Descriptors::both:
      return std::hypot(ruling, border);
    case Descriptors::ruling:
      return std::abs(ruling);
    case Descriptors::border:
      return std::abs(border);
    case Descriptors::none:
      return 0;
  }
  return 0;
}

/// Two neighbouring loops and the share of the power that the faster one has.
struct Blend {
  std::size_t below = 0, above = 0;
  double share = 0;
};

/// @param logs  logarithms of the loops' speeds, ascending
Blend blend(const std::vector<double>& logs, double speed) {
  const double here = std::log(std::max(speed, 1e-9));
  if (here <= logs.front()) return {};
  const auto next = std::upper_bound(logs.begin(), logs.end(), here);
  const std::size_t above = next - logs.begin();
  if (next == logs.end()) return {above - 1, above - 1, 0};
  return {above - 1, above, (here - logs[above - 1]) / (*next - logs[above - 1])};
}

std::vector<double> log_speeds(const SoundBank& bank, const std::vector<int>& loops) {
  std::vector<double> logs;
  for (const int i : loops) logs.push_back(std::log(std::max(bank.sounds.at(i).speed, 1e-9)));
  return logs;
}

class BankVoices final : public SoundVoices {
 public:
  BankVoices(SoundBank bank, const SoundOptions& options, const PaperMaterial& material)
      : bank_(std::move(bank)), options_(options), material_(material) {}

  [[nodiscard]] std::map<std::string, double> diagnostics() const override {
    return {{"bank_checksum", recorded_checksum(bank_)}};
  }

  [[nodiscard]] EventVoice voice(const SoundEvent& event, const ResonatorShape& /*shape*/,
                                 RandomStream random) const override {
    if (event.kind == SoundKind::friction) return friction(event, random);
    const std::vector<int> order = nearest_sounds(bank_, event, options_.descriptors);
    if (order.empty()) return {};
    // Sounds as near as the last of the nearest are drawn from too: without descriptors, all.
    const std::size_t last = std::min(options_.nearest, static_cast<int>(order.size())) - 1;
    const auto far = [&](int sound) {
      return distance(bank_.sounds[sound], event, options_.descriptors);
    };
    const double reach = far(order[last]) * (1 + 1e-12);
    std::size_t count = last + 1;
    while (count < order.size() && far(order[count]) <= reach) ++count;
    const int sound = order[random.below(static_cast<std::uint32_t>(count))];
    EventVoice made{voice_of(event, bank_, sound, material_), sound};
    made.voice.rate *= adaptation(event, sound);
    made.voice.rate *= 1 + options_.detune * (2 * random.uniform() - 1);
    return made;
  }

 private:
  /// Recorded is the loop of the speed that is nearest to the fastest moment.
  [[nodiscard]] EventVoice friction(const SoundEvent& event, RandomStream& random) const {
    std::map<double, std::vector<int>> by_speed;
    for (const int i : bank_.of(SoundKind::friction)) by_speed[bank_.sounds[i].speed].push_back(i);
    if (by_speed.empty()) return {};
    std::vector<int> loops;
    for (const auto& entry : by_speed) {
      loops.push_back(entry.second[random.below(static_cast<std::uint32_t>(entry.second.size()))]);
    }
    double fastest = 0;
    for (const Sliding& at : event.sliding) fastest = std::max(fastest, at.speed);
    const Blend heard = blend(log_speeds(bank_, loops), fastest);
    const int sound = loops[heard.share > 0.5 ? heard.above : heard.below];
    EventVoice made{voice_of(event, bank_, sound, material_), sound};
    made.own =
        std::make_shared<const Eigen::VectorXf>(blended_friction(bank_, loops, event.sliding));
    made.voice.samples = {made.own->data(), static_cast<std::size_t>(made.own->size())};
    return made;
  }

  /// By which a sound is played faster.
  [[nodiscard]] double adaptation(const SoundEvent& event, int sound) const {
    const BankSound& chosen = bank_.sounds[sound];
    if (!options_.adapt || !(chosen.width > 0) || !(event.area > 0)) return 1;
    if (!(event.ruling_length > 0) || !(chosen.ruling_length > 0)) return 1;
    const auto pitch = [&](double length, double width, double bow) {
      return lowest_frequency({.length = length, .width = width, .bow = bow}, chosen.root_along,
                              chosen.root_across, material_);
    };
    const double wanted =
        pitch(event.ruling_length, event.area / event.ruling_length, event.curvature);
    const double own = pitch(chosen.ruling_length, chosen.width, chosen.bow);
    if (!(wanted > 0) || !(own > 0)) return 1;  // a panel that nothing holds
    constexpr double kMost = 4;                 // two octaves
    return std::clamp(wanted / own, 1 / kMost, kMost);
  }

  SoundBank bank_;
  SoundOptions options_;
  PaperMaterial material_;
};

}  // namespace

void describe(OptionVisitor& v, SoundOptions& o) {
  static constexpr std::array<std::string_view, 5> kNames{"all", "both", "ruling", "border",
                                                          "none"};
  describe(v, o.stage);
  describe_group(v, "bank", o.bank,
                 {.doc = "bank of sounds that is generated where the scene has none"});
  describe_choice(
      v, "descriptors", o.descriptors, kNames,
      {.doc = "lengths of a resonator that choose its sound: l_r, l_c and its width, the "
              "thesis' l_r and l_c, one of both, or none"});
  v.value("nearest", o.nearest,
          {.doc = "nearest sounds of the bank that one is drawn from", .min = 1, .max = 100000});
  v.value("adapt", o.adapt,
          {.doc = "whether a sound is played faster where the resonator is narrower or more bent"});
  v.value("detune", o.detune,
          {.doc = "largest change of pitch at random, relative", .min = 0, .max = 0.5});
}

std::vector<int> nearest_sounds(const SoundBank& bank, const SoundEvent& event,
                                Descriptors descriptors) {
  std::vector<std::pair<double, int>> order;
  for (const int i : bank.of(event.kind)) {
    order.emplace_back(distance(bank.sounds[i], event, descriptors), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<int> sounds;
  for (const auto& entry : order) sounds.push_back(entry.second);
  return sounds;
}

Eigen::VectorXf blended_friction(const SoundBank& bank, const std::vector<int>& loops,
                                 const std::vector<Sliding>& sliding) {
  if (loops.empty()) throw Error("has no loop of friction", "bank", "one at least");
  if (sliding.empty()) throw Error("has no time at which it slides", "event of friction");
  const std::vector<double> logs = log_speeds(bank, loops);
  std::vector<const Eigen::VectorXf*> samples;
  for (const int i : loops) {
    samples.push_back(&bank.sounds[i].samples);
    if (samples.back()->size() == 0) throw Error("has no samples", "loop " + std::to_string(i));
  }
  const double start = sliding.front().time - kSlideFade;
  const double length = sliding.back().time + kSlideFade - start;
  const auto n = static_cast<Eigen::Index>(std::ceil(length * bank.sample_rate)) + 1;
  Eigen::VectorXf out(n);
  std::size_t key = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double now = start + static_cast<double>(i) / bank.sample_rate;
    while (key + 2 < sliding.size() && sliding[key + 1].time <= now) ++key;
    const Sliding &a = sliding[key], &b = sliding[std::min(key + 1, sliding.size() - 1)];
    const double share =
        b.time > a.time ? std::clamp((now - a.time) / (b.time - a.time), 0.0, 1.0) : 0;
    const Blend heard = blend(logs, a.speed + share * (b.speed - a.speed));
    const Eigen::VectorXf &slow = *samples[heard.below], &fast = *samples[heard.above];
    out[i] = static_cast<float>(std::sqrt(1 - heard.share)) * slow[i % slow.size()] +
             static_cast<float>(std::sqrt(heard.share)) * fast[i % fast.size()];
  }
  return out;
}

std::shared_ptr<const SoundVoices> bank_voices(SoundBank bank, const SoundOptions& options,
                                               const PaperMaterial& material) {
  return std::make_shared<BankVoices>(std::move(bank), options, material);
}

}  // namespace geoprior::sound
