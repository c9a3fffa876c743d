#pragma once

#include <memory>

#include "models/sound/process.h"
#include "models/sound/voices/bank.h"

namespace geoprior::sound {

/// The sound of an animated sheet, put together from a bank (thesis 3.2.3; Schreck et al. 2016).
///
/// Sudden changes of the sign of curvature, sliding and steps of tears are events
/// (models/sound/events/detector.h). The part of the sheet about a flip that swings freely, its
/// resonator, is described by the mean length of its rulings l_r and the length of its free border
/// l_c. What it sounds like is drawn from the sounds of its kind in the bank whose descriptors are
/// nearest,
///
///   d^2 = ln^2(l_r / l_r') + ln^2((l_c + l_0) / (l_c' + l_0)),     l_0 = 5 mm,
///
/// as loud as its energy; `all` adds ln^2(w / w') where the sounds have widths.
///
/// Two lengths do not say how wide a resonator is, w = A / l_r, nor how bent. A sound is played
/// faster by the ratio of the lowest frequencies of a panel of the resonator's lengths and
/// curvature and of its own, held in the same way, two octaves at most (the thesis says that sounds
/// are adapted, not how). A user's sounds without width are played as they are. The method does not
/// know how the sheet is bent beyond these numbers, nor what it lies on.
///
/// Sliding is heard as loops of noise, one drawn for each speed of the bank, of which the two
/// nearest to the speed of the moment are mixed: powers are linear in its logarithm.
struct SoundOptions {
  enum class Descriptors { all, both, ruling, border, none };
  SoundStage stage;
  BankOptions bank;  ///< unless the scene has one
  Descriptors descriptors = Descriptors::all;
  int nearest = 3;
  bool adapt = true;
  double detune = 0.05;
};
void describe(OptionVisitor& v, SoundOptions& options);

/// Numbers of the sounds of the event's kind in the order of their distance; of equals the lower
/// number first. Friction and tears have none: all are equal.
std::vector<int> nearest_sounds(const SoundBank& bank, const SoundEvent& event,
                                SoundOptions::Descriptors descriptors);

/// Loops of friction blended by the speed of the moment, at the rate of the bank, from `kSlideFade`
/// before the first time of the sliding to as long after the last (sound_voice.h); of root mean
/// square 1 where the loops are, which are not correlated. Below the speed of the slowest loop that
/// one is heard alone, above that of the fastest this one.
/// @param loops   numbers of sounds of the bank, ascending in speed
/// @throws Error  without loops, samples of a loop, or times
Eigen::VectorXf blended_friction(const SoundBank& bank, const std::vector<int>& loops,
                                 const std::vector<Sliding>& sliding);

/// @param bank  valid (`require_valid`)
std::shared_ptr<const SoundVoices> bank_voices(SoundBank bank, const SoundOptions& options,
                                               const PaperMaterial& material);

}  // namespace geoprior::sound
