#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frame.h"
#include "testbed/view/panel.h"
#include "testbed/view/picture.h"

namespace geoprior {

/// A piece of the curve in which a plane cuts a surface, in the plane's coordinates (right, up).
/// The solid is on the left.
struct SectionSegment {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
};

/// Cuts the triangles of a part by the plane through `window.center` across `window.direction`.
/// Each triangle gives at most one segment; a vertex on the plane counts as in front of it.
std::vector<SectionSegment> cut(const Part& part, const ViewWindow& window);

/// Winding number of the section curves about a point: 0 outside, 1 inside, 2 where the solid
/// overlaps itself, negative where it is inside out.
int winding_number(const std::vector<SectionSegment>& segments, const Eigen::Vector2d& point);

/// Draws a section: the inside light, self-overlap red, inside out blue, the curve dark.
Picture draw_section(const std::vector<SectionSegment>& segments, const ViewWindow& window,
                     int width_px, int height_px);

}  // namespace geoprior
