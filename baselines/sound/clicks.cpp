#include "baselines/sound/clicks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/sound/voices/voice.h"

namespace geoprior::sound {
namespace {

/// A bank of one click.
SoundBank click_bank(double length) {
  SoundBank bank;
  BankSound& click = bank.sounds.emplace_back();
  const auto n = std::max<Eigen::Index>(2, static_cast<Eigen::Index>(length * bank.sample_rate));
  Eigen::VectorXd samples(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    samples[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * t);
  }
  const double loud = pressure_energy(click.energy, click.free_border) * bank.sample_rate;
  click.samples = (samples * std::sqrt(loud / samples.squaredNorm())).cast<float>();
  return bank;
}

class ClickVoices final : public SoundVoices {
 public:
  explicit ClickVoices(const ClickOptions& options) : bank_(click_bank(options.length)) {}

  [[nodiscard]] EventVoice voice(const SoundEvent& event, const ResonatorShape& /*shape*/,
                                 RandomStream /*random*/) const override {
    SoundEvent click = event;
    click.kind = SoundKind::crac;
    return {voice_of(click, bank_, 0, {}), 0};
  }

 private:
  SoundBank bank_;
};

}  // namespace

void describe(OptionVisitor& v, ClickOptions& o) {
  describe(v, o.stage);
  v.value("length", o.length, {.doc = "length of a click", .unit = "s", .min = 1e-4, .max = 1});
}

std::shared_ptr<const SoundVoices> click_voices(const ClickOptions& options) {
  return std::make_shared<ClickVoices>(options);
}

}  // namespace geoprior::sound
