#pragma once

#include <memory>

#include "models/sound/process.h"

namespace geoprior::sound {

/// Baseline: silence, with one click an event, as loud as the event is, whatever makes it. Sliding
/// is one click where it begins.
///
/// A click holds every frequency that is heard, as much of each, and no constant pressure: a single
/// sample, less a raised cosine of the same area that is `length` long about it. Its spectrum is
/// 1 - P(f length), P the cosine's: 0 at f = 0, a half at 1 / length, 1 from 2 / length on.
/// Between two samples the mixer's cubic takes up to 3 dB of it at 16 kHz.
struct ClickOptions {
  SoundStage stage;
  double length = 1e-2;
};
void describe(OptionVisitor& v, ClickOptions& options);
std::shared_ptr<const SoundVoices> click_voices(const ClickOptions& options);

}  // namespace geoprior::sound
