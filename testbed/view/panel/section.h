#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frame.h"
#include "testbed/view/figure/picture.h"
#include "testbed/view/panel/content.h"
#include "testbed/view/panel/plane_curves.h"

namespace geoprior {

/// Cuts the triangles of a part by the plane through `window.center` across `window.direction`: a
/// curve in the plane's coordinates (right, up), the solid on its left.
/// Each triangle gives at most one segment; a vertex on the plane counts as in front of it.
std::vector<CurveSegment> cut(const Part& part, const ViewWindow& window);

/// Draws a section: the inside light, self-overlap red, inside out blue, the curve dark.
Picture draw_section(const std::vector<CurveSegment>& segments, const ViewWindow& window,
                     int width_px, int height_px);

}  // namespace geoprior
