#include "models/sound/voices/voice.h"

#include <algorithm>
#include <cmath>

namespace geoprior::sound {

Voice voice_of(const SoundEvent& event, const SoundBank& bank, int sound,
               const PaperMaterial& material) {
  const BankSound& chosen = bank.sounds.at(sound);
  Voice voice;
  voice.time = event.time;
  voice.position = event.position;
  voice.samples = {chosen.samples.data(), static_cast<std::size_t>(chosen.samples.size())};
  voice.rate = bank.sample_rate;
  if (event.kind != SoundKind::friction) {
    voice.gain = std::sqrt(pressure_energy(event.energy, event.free_border) /
                           pressure_energy(chosen.energy, chosen.free_border));
    return voice;
  }
  constexpr double kGravity = 9.81;  // m/s^2
  constexpr double kBorder = 0.1;    // m: what rubs radiates as a border of that length
  voice.envelope.emplace_back(event.sliding.front().time - kSlideFade, 0);
  for (const Sliding& at : event.sliding) {
    const double weight = material.friction * material.area_density * kGravity;
    const double power = std::max(at.power, weight * at.speed * at.area);
    voice.envelope.emplace_back(at.time, std::sqrt(pressure_energy(power, kBorder)));
  }
  voice.envelope.emplace_back(event.sliding.back().time + kSlideFade, 0);
  return voice;
}

}  // namespace geoprior::sound
