#pragma once

#include "core/random.h"
#include "models/sound/sheet.h"
#include "models/sound/voices/bank.h"
#include "models/sound/voices/mixer.h"

namespace geoprior::sound {

inline constexpr double kSlideFade = 5e-3;  ///< s: a sound of sliding before and after it slides

/// A sound of the bank as loud as the event is. Of friction a loop whose gain follows its power:
/// that of the recorded pressure, and at least that of the sheet's own weight.
Voice voice_of(const SoundEvent& event, const SoundBank& bank, int sound,
               const PaperMaterial& material);

}  // namespace geoprior::sound
