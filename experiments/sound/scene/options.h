#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "experiments/paper/scene/sheet_options.h"
#include "experiments/sound/scene/sheet_files.h"
#include "experiments/sound/scene/swatches.h"

namespace geoprior::sound {

/// What of a sheet's material is heard.
struct HeardMaterial {
  PaperMaterial paper;
};
void describe(OptionVisitor& v, HeardMaterial& options);

/// One of `handles`: what holds the sheet, and so ends a resonator.
struct HoldOptions {
  paper::HandleOptions handle;
};
void describe(OptionVisitor& v, HoldOptions& options);

/// Another animation of the sheet, which variants listen to by its name.
struct OtherAnimationOptions {
  std::string name, path;
};
void describe(OptionVisitor& v, OtherAnimationOptions& options);

/// `[scene]` of a sound experiment: the sheet as its animation has it.
struct SoundSceneOptions {
  paper::PatternOptions pattern;
  HeardMaterial material;
  paper::ToughnessOptions toughness;
  std::vector<HoldOptions> handles;
  std::vector<paper::ObstacleOptions> obstacles;
  std::optional<SheetFileOptions> animation;
  std::vector<OtherAnimationOptions> others;
  std::optional<SwatchOptions> swatches;
  std::optional<std::string> bank;
};
void describe(OptionVisitor& v, SoundSceneOptions& options);

}  // namespace geoprior::sound
