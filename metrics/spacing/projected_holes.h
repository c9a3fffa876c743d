#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace geoprior {

/// A mesh and flat patches in the plane of a view that cover the holes of its projection: places
/// that no triangle covers and that the projection encloses, such as the neck of a garment seen
/// from above, through which the open hem is seen. A drawn silhouette is an outer outline and knows
/// nothing of them.
///
/// Holes are found on horizontal lines, `rows` over the height, and covered by a rectangle for each
/// line, a row wider and taller than the line's part of the hole: the patches lie over the border
/// of the hole by one to two rows. A hole that is less than a row high may stay; one that is parted
/// from the outside by less than that may be taken for the outside or the other way round.
///
/// @param view    as in `projected_points`
/// @param rows    at least 2
/// @return        the mesh with the patches' vertices and triangles appended; the same mesh where
///                there is no hole
/// @throws Error  as `projected_points`; on rows below 2
TriMesh with_filled_holes(const TriMesh& mesh, const Eigen::Matrix3d& view, int rows = 1024);

}  // namespace geoprior
