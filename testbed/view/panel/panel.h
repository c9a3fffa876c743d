#pragma once

#include "testbed/view/figure/picture.h"
#include "testbed/view/panel/content.h"

namespace geoprior {

/// Draws parts in three dimensions: three lights that follow the camera, ambient occlusion,
/// supersampled edges. Needs a Display.
/// @throws Error  when OpenGL is missing, naming the package
Picture draw_panel(const PanelParts& parts, const ViewWindow& window, const PanelStyle& style,
                   int width_px, int height_px);

}  // namespace geoprior
