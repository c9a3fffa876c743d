#pragma once

#include <memory>

#include "experiments/grammar/scene/scene.h"

namespace geoprior::grammar {

/// A scene whose files are those of the experiments.
inline std::shared_ptr<GrammarScene> loaded(const GrammarSceneOptions& options) {
  return load_grammar_scene(options, GEOPRIOR_SOURCE_DIR "/experiments/grammar", 1);
}

}  // namespace geoprior::grammar
