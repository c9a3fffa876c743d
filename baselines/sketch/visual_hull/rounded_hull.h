#pragma once

#include <Eigen/Core>

#include "models/sketch/surface/sketch_surface.h"

namespace geoprior::sketch {

/// A visual hull whose ridges between the faces of different views are rounded by a ball that rolls
/// inside of it: the opening of the hull by a ball of a radius r, but for the corners that a
/// silhouette itself has, which stay as they were drawn.
///
/// A point x of the hull has the signed distance d_v and the outward normal n_v of every view's
/// silhouette. The ball's centre is the point y nearest to x of { n_v . (y - x) + d_v <= -r for all
/// v }, and x goes to y + r (x - y) / |x - y| where it is farther than r from y; four times, since
/// silhouettes bend. Faces stay in place, so that silhouettes do but where a ridge carries them.
/// Within r of a silhouette's own corner only the nearer of its two sides is seen. Rims are not
/// rounded: silhouettes are taken to go straight on beyond drawn borders. Of a hull
/// whose sections are those of the top view, only ridges between drawn silhouettes are rounded.
///
/// @param radius  r (m), at least 0
/// @return        n x 3, the vertices of the hull's mesh
Eigen::MatrixX3d rounded_hull(const SketchSurface& surface, double radius);

}  // namespace geoprior::sketch
