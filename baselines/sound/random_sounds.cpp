#include "baselines/sound/random_sounds.h"

#include <utility>

#include "models/sound/voices/voice.h"

namespace geoprior::sound {
namespace {

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

void describe(OptionVisitor& v, RandomSoundOptions& o) {
  describe(v, o.stage);
  describe_group(v, "bank", o.bank,
                 {.doc = "bank of sounds that is generated where the scene has none"});
}

std::shared_ptr<const SoundVoices> random_voices(SoundBank bank, const PaperMaterial& material) {
  return std::make_shared<RandomVoices>(std::move(bank), material);
}

}  // namespace geoprior::sound
