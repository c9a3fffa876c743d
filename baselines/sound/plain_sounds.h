#pragma once

#include <memory>

#include "models/sound/process.h"
#include "models/sound/voices/bank.h"

namespace geoprior::paper {

/// Baseline: silence, with one click an event: a raised cosine as loud as the event is, whatever
/// makes it. Sliding is one click where it begins.
struct ClickOptions {
  SoundStage stage;
  double length = 1e-3;  ///< of the click (s)
};
void describe(OptionVisitor& v, ClickOptions& options);
std::shared_ptr<const SoundVoices> click_voices(const ClickOptions& options);

/// Baseline: a sound of the bank's drawn at random for each event, of its kind: flaps and cracs are
/// one.
struct RandomSoundOptions {
  SoundStage stage;
  BankOptions bank;  ///< unless the scene has one
};
void describe(OptionVisitor& v, RandomSoundOptions& options);
/// @param bank  valid (`require_valid`)
std::shared_ptr<const SoundVoices> random_voices(SoundBank bank, const PaperMaterial& material);

}  // namespace geoprior::paper
