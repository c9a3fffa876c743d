#include "baselines/sound/clicks.h"
#include "baselines/sound/modal/modal.h"
#include "baselines/sound/random_sounds.h"
#include "experiments/sound/scene/bank_cache.h"
#include "experiments/sound/scene/scene.h"
#include "experiments/sound/topic.h"
#include "solvers/sound/sound.h"
#include "testbed/formats/wav_file.h"

namespace geoprior::sound {
namespace {

std::vector<std::byte> encode(const Eigen::MatrixXd& samples, int sample_rate) {
  return wav_bytes({sample_rate, samples});
}

/// The user's, or one that the options generate.
SoundBank bank_of(const SoundScene& scene, const BankOptions& options, std::uint64_t seed) {
  if (scene.bank) return *scene.bank;
  return cached_bank(scene.sheet.material, options, seed, bank_folder());
}

}  // namespace

std::vector<MethodEntry> methods() {
  using S = SoundScene;
  return {
      method_entry<S, SoundOptions>(
          "sound", false, "events of an animated sheet, sounded by a bank indexed by resonators",
          "thesis 3.2.3; Schreck et al. 2016",
          [](const S& scene, const SoundOptions& options, RunContext& context) {
            return make_sound_process(scene.sheet, scene.named(options.stage.animation),
                                      options.stage,
                                      bank_voices(bank_of(scene, options.bank, context.seed()),
                                                  options, scene.sheet.material),
                                      encode);
          }),
      method_entry<S, ClickOptions>(
          "clicks", true, "the same events, one click each", "docs/methods/sound.md",
          [](const S& scene, const ClickOptions& options, RunContext&) {
            return make_sound_process(scene.sheet, scene.named(options.stage.animation),
                                      options.stage, click_voices(options), encode);
          }),
      method_entry<S, RandomSoundOptions>(
          "random-sounds", true, "the same events, a sound of the bank at random each",
          "docs/methods/sound.md",
          [](const S& scene, const RandomSoundOptions& options, RunContext& context) {
            return make_sound_process(
                scene.sheet, scene.named(options.stage.animation), options.stage,
                random_voices(bank_of(scene, options.bank, context.seed()), scene.sheet.material),
                encode);
          }),
      method_entry<S, ModalSoundOptions>(
          "modal", true, "picked events, sounded by the eigenmodes of their resonators",
          "docs/methods/sound.md; Fahy and Gardonio 2007",
          [](const S& scene, const ModalSoundOptions& options, RunContext&) {
            return make_sound_process(scene.sheet, scene.named(options.stage.animation),
                                      options.stage, modal_voices(options, scene.sheet.material),
                                      encode);
          }),
  };
}

std::vector<DiagnosticEntry> diagnostics() {
  DiagnosticTable table;
  table.measured("sound_events", {"events", "1", "events since the start"});
  table.measured("sound_peak",
                 {"true_peak", "dBFS", "of the whole sound; absent when it is silent"});
  table.unmeasured(
      "metrics hear the sound alone, not what it was made of",
      {{"remeshed_share", "1",
        "cells of the sheet on which the mesh has changed since the frame before: nothing is heard "
        "there, unless detection.flips.remeshing"},
       {"bank_checksum", "1", "lowest 48 bits of the FNV-1a hash of the bank that was played"},
       {"gain_lowered", "dB", "by which the whole was made quieter to stay under highest_peak"}});
  return table.rows();
}

}  // namespace geoprior::sound
