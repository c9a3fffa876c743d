#pragma once

#include <memory>

#include "models/sound/process.h"
#include "models/sound/voices/bank.h"

namespace geoprior::sound {

/// Baseline: a sound of the bank's drawn at random for each event, of its kind: flaps and cracs are
/// one.
struct RandomSoundOptions {
  SoundStage stage;
  BankOptions bank;  ///< unless the scene has one
};
void describe(OptionVisitor& v, RandomSoundOptions& options);
/// @param bank  valid (`require_valid`)
std::shared_ptr<const SoundVoices> random_voices(SoundBank bank, const PaperMaterial& material);

}  // namespace geoprior::sound
