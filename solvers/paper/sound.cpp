#include "solvers/paper/sound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "models/paper/sound_voice.h"

namespace geoprior::paper {
namespace {

using Descriptors = SoundOptions::Descriptors;

double distance(const BankSound& sound, const SoundEvent& event, Descriptors descriptors) {
  constexpr double kBorder = 5e-3;  // l_0 (m)
  if (event.kind == SoundKind::tear) return 0;
  if (event.kind == SoundKind::friction) {
    double speed = 0;
    for (const Sliding& at : event.sliding) speed = std::max(speed, at.speed);
    return std::abs(std::log(std::max(speed, 1e-9) / std::max(sound.speed, 1e-9)));
  }
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

class BankVoices final : public SoundVoices {
 public:
  BankVoices(SoundBank bank, const SoundOptions& options, const PaperMaterial& material)
      : bank_(std::move(bank)), options_(options), material_(material) {}

  [[nodiscard]] std::map<std::string, double> diagnostics() const override {
    return {{"bank_checksum", recorded_checksum(bank_)}};
  }

  [[nodiscard]] EventVoice voice(const SoundEvent& event, const ResonatorShape& /*shape*/,
                                 RandomStream random) const override {
    const std::vector<int> order = nearest_sounds(bank_, event, options_.descriptors);
    if (order.empty()) return {};
    // Sounds as near as the last of the nearest are drawn from too: without descriptors, all.
    const auto last =
        static_cast<std::size_t>(std::min(options_.nearest, static_cast<int>(order.size())) - 1);
    const auto far = [&](int sound) {
      return distance(bank_.sounds[static_cast<std::size_t>(sound)], event, options_.descriptors);
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
  /// By which a sound is played faster.
  [[nodiscard]] double adaptation(const SoundEvent& event, int sound) const {
    const BankSound& chosen = bank_.sounds[static_cast<std::size_t>(sound)];
    if (!options_.adapt || !(chosen.width > 0) || !(event.area > 0)) return 1;
    if (!(event.ruling_length > 0) || !(chosen.ruling_length > 0)) return 1;
    const auto pitch = [&](double length, double width) {
      return std::hypot(std::pow(chosen.root_across / width, 2),
                        std::pow(chosen.root_along / length, 2));
    };
    constexpr double kMost = 4;  // two octaves
    return std::clamp(pitch(event.ruling_length, event.area / event.ruling_length) /
                          pitch(chosen.ruling_length, chosen.width),
                      1 / kMost, kMost);
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
  describe_group(v, "bank", o.bank, {.doc = "that is generated where the scene has none"});
  describe_choice(v, "descriptors", o.descriptors, kNames,
                  {.doc = "of a resonator that choose its sound: l_r, l_c and its width, the "
                          "thesis' l_r and l_c, one of both, or none"});
  v.value("nearest", o.nearest, {.doc = "sounds that are drawn from", .min = 1, .max = 100000});
  v.value("adapt", o.adapt, {.doc = "play a sound faster where the resonator is narrower"});
  v.value("detune", o.detune, {.doc = "largest change of pitch, relative", .min = 0, .max = 0.5});
}

std::vector<int> nearest_sounds(const SoundBank& bank, const SoundEvent& event,
                                Descriptors descriptors) {
  std::vector<std::pair<double, int>> order;
  for (const int i : bank.of(event.kind)) {
    order.emplace_back(distance(bank.sounds[static_cast<std::size_t>(i)], event, descriptors), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<int> sounds;
  for (const auto& entry : order) sounds.push_back(entry.second);
  return sounds;
}

std::shared_ptr<const SoundVoices> bank_voices(SoundBank bank, const SoundOptions& options,
                                               const PaperMaterial& material) {
  return std::make_shared<BankVoices>(std::move(bank), options, material);
}

}  // namespace geoprior::paper
