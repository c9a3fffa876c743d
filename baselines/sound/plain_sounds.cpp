#include "baselines/sound/plain_sounds.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "models/sound/voices/voice.h"

namespace geoprior::paper {
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

class RandomVoices final : public SoundVoices {
 public:
  RandomVoices(SoundBank bank, const PaperMaterial& material)
      : bank_(std::move(bank)), material_(material), snaps_(bank_.of(SoundKind::flap)) {
    const std::vector<int> cracs = bank_.of(SoundKind::crac);
    snaps_.insert(snaps_.end(), cracs.begin(), cracs.end());
  }

  [[nodiscard]] std::map<std::string, double> diagnostics() const override {
    return {{"bank_checksum", recorded_checksum(bank_)}};
  }

  [[nodiscard]] EventVoice voice(const SoundEvent& event, const ResonatorShape& /*shape*/,
                                 RandomStream random) const override {
    const bool snap = event.kind == SoundKind::flap || event.kind == SoundKind::crac;
    const std::vector<int> sounds = snap ? snaps_ : bank_.of(event.kind);
    if (sounds.empty()) return {};
    const int sound = sounds[random.below(static_cast<std::uint32_t>(sounds.size()))];
    return {voice_of(event, bank_, sound, material_), sound};
  }

 private:
  SoundBank bank_;
  PaperMaterial material_;
  std::vector<int> snaps_;
};

}  // namespace

void describe(OptionVisitor& v, ClickOptions& o) {
  describe(v, o.stage);
  v.value("length", o.length, {.doc = "of the click", .unit = "s", .min = 1e-4, .max = 1});
}

void describe(OptionVisitor& v, RandomSoundOptions& o) {
  describe(v, o.stage);
  describe_group(v, "bank", o.bank, {.doc = "that is generated where the scene has none"});
}

std::shared_ptr<const SoundVoices> click_voices(const ClickOptions& options) {
  return std::make_shared<ClickVoices>(options);
}

std::shared_ptr<const SoundVoices> random_voices(SoundBank bank, const PaperMaterial& material) {
  return std::make_shared<RandomVoices>(std::move(bank), material);
}

}  // namespace geoprior::paper
