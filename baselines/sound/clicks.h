#pragma once

#include <memory>

#include "models/sound/process.h"

namespace geoprior::sound {

/// Baseline: silence, with one click an event: a raised cosine as loud as the event is, whatever
/// makes it. Sliding is one click where it begins.
struct ClickOptions {
  SoundStage stage;
  double length = 1e-3;
};
void describe(OptionVisitor& v, ClickOptions& options);
std::shared_ptr<const SoundVoices> click_voices(const ClickOptions& options);

}  // namespace geoprior::sound
