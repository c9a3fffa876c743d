#include "baselines/sound/clicks.h"

#include <cmath>
#include <numbers>

#include "models/sound/voices/voice.h"

namespace geoprior::sound {
namespace {

/// One sample, less a raised cosine of the same area about it: 1 - P(f length), P as
/// `pulse_spectrum`.
Eigen::VectorXd broadband_click(double length, int sample_rate) {
  const auto half = static_cast<Eigen::Index>(std::ceil(length / 2 * sample_rate));
  const Eigen::Index n = 2 * half + 1;
  Eigen::VectorXd trough(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t = static_cast<double>(i + 1) / static_cast<double>(n + 1);
    trough[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * t);
  }
  return Eigen::VectorXd::Unit(n, half) - trough / trough.sum();
}

/// A bank of one click.
SoundBank click_bank(double length) {
  SoundBank bank;
  BankSound& click = bank.sounds.emplace_back();
  const Eigen::VectorXd samples = broadband_click(length, bank.sample_rate);
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
  v.value("length", o.length,
          {.doc = "length of a click: its spectrum is flat above twice the inverse",
           .unit = "s",
           .min = 1e-4,
           .max = 1});
}

std::shared_ptr<const SoundVoices> click_voices(const ClickOptions& options) {
  return std::make_shared<ClickVoices>(options);
}

}  // namespace geoprior::sound
