#pragma once

#include <optional>

#include "core/frame.h"
#include "experiments/sketch/scene/scene.h"

namespace geoprior::sketch {

/// By how much a colour has more of the background's greatest channel than of both others: what a
/// chroma key goes by. Positive of the background alone where nothing else has its hue.
double key_excess(const Eigen::RowVector3d& colour, const Eigen::RowVector3d& background);

/// Share of the texels beside borders of pieces that have the colour of the photograph's background
/// (`scene.textures.background`): a `key_excess` of more than 0.15 of the background's own, so that
/// a sixth of it mixed in counts. Absent without the part "texels" or a known background.
std::optional<double> background_texels(const SketchScene& scene, const Frame& frame);

}  // namespace geoprior::sketch
