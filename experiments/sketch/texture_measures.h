#pragma once

#include <optional>

#include "core/frame.h"
#include "experiments/sketch/scene/scene.h"

namespace geoprior::sketch {

/// Share of the texels beside borders of pieces that have the colour of the photograph's background
/// (`scene.textures.background`): nearer to it than 0.3 of the way from it to the median colour of
/// these texels, or than 40 of 255 where they are alike. Absent without the part "texels" or a
/// known background.
std::optional<double> background_texels(const SketchScene& scene, const Frame& frame);

}  // namespace geoprior::sketch
