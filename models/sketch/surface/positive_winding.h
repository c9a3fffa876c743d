#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior::sketch {

/// A closed chain of points in the plane; the last is joined to the first.
using PlaneLoop = std::vector<Eigen::Vector2d>;

/// Border of the region around which closed curves wind a positive number of times in total.
///
/// A chain that is the sum of the borders of counter-clockwise areas winds around each point as
/// often as areas cover it, so that this is the border of their union, whatever the chain crosses.
/// Everything is decided exactly; only the coordinates of crossings are rounded to doubles.
///
/// @param curves  closed chains; segments may cross and coincide, points may repeat
/// @return        the region on the left: outer loops counter-clockwise, those of holes clockwise,
///                longest extent first, each from its leftmost point on; empty for an empty region
/// @throws Error  naming a point that is not finite
/// Source: positive fill rule of polygon clipping; de Berg et al. 2008, Computational Geometry,
/// chapter 2.
std::vector<PlaneLoop> positive_winding_border(const std::vector<PlaneLoop>& curves);

/// Area that the loop encloses (m²); negative when it runs clockwise.
double loop_area(const PlaneLoop& loop);

}  // namespace geoprior::sketch
