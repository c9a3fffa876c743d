#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/method.h"
#include "models/sound/animation.h"
#include "models/sound/events/detector.h"
#include "models/sound/voices/mixer.h"

namespace geoprior::sound {

/// What an event sounds like: what distinguishes the methods.
struct EventVoice {
  Voice voice;
  int sample = -1;                                  ///< number of the bank's sound; -1: none
  std::map<std::string, double> numbers = {};       ///< recorded with the event
  std::shared_ptr<const Eigen::VectorXf> own = {};  ///< what `voice` plays, unless a bank has it
};
class SoundVoices {
 public:
  virtual ~SoundVoices() = default;
  /// @param shape   of the resonator; empty unless `needs_shapes` and the event is a picked one
  /// @param random  of this event alone
  [[nodiscard]] virtual EventVoice voice(const SoundEvent& event, const ResonatorShape& shape,
                                         RandomStream random) const = 0;
  [[nodiscard]] virtual bool needs_shapes() const { return false; }
  /// Recorded in the last frame.
  [[nodiscard]] virtual std::map<std::string, double> diagnostics() const { return {}; }
};

/// Flaps and cracs that are picked to be heard alone.
struct PickedOptions {
  int most = 0;
  int every = 1;
};
void describe(OptionVisitor& v, PickedOptions& options);

/// The bytes of a sound file: rows are samples, columns channels, full scale 1.
using EncodeSound =
    std::function<std::vector<std::byte>(const Eigen::MatrixXd& samples, int sample_rate)>;

struct SoundStage {
  std::string animation;
  DetectionOptions detection;
  MixOptions mix;
  PickedOptions picked;
  double tail = 0.5;
  bool surface = true;
};
void describe(OptionVisitor& v, SoundStage& options);

/// The loop that all methods of sound share: finds the events of an animated sheet, frame by frame,
/// and at the end mixes what they sound like into the artifact "sound.wav", which begins at
/// time 0, or at the first frame when that is earlier.
///
/// Each frame has the parts "events" (points: where they are; arrays "kind" [1] (index in
/// kSoundKinds), "time" [s], "energy" [J], "l_r", "l_c" [m], "area" [m^2], "sample" [1]) and
/// "resonators" (triangles: their cells in space; cell arrays "kind", "event" [1]) of the events
/// that have become known, and "surface" (as of the animation, point array "pattern"). Each event
/// is pushed with the numbers ruling_length_m, free_border_m, area_m2, flipped_area_m2,
/// curvature_per_m, blocked_share, latency_s, sample, and those of its voice. Picked
/// events are also written alone to "voices.wav", and have voice_start_s, voice_length_s.
/// Diagnostics: events (since the start), remeshed_share, and after the last frame true_peak (dBFS)
/// and gain_lowered (dB). Phases: "read", "detect", "resonators", "choose", "mix", "encode", and
/// "sound": detection, resonators, choice and mix together.
std::unique_ptr<Process> make_sound_process(const Sheet& sheet,
                                            std::shared_ptr<const SheetAnimation> animation,
                                            const SoundStage& stage,
                                            std::shared_ptr<const SoundVoices> voices,
                                            EncodeSound encode);

}  // namespace geoprior::sound
