#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace geoprior {

/// Share of the points of a rim below which there is no surface: where one sees between two
/// overlapping layers.
///
/// Below a point is the segment from it towards the centre of the rim's circle, over half of the
/// radius. The ends of the rim, where layers are joined side by side, may be left out.
///
/// @param rim    n x 3, points along a circular arc (`circular_arc`), three or more
/// @param ends   share of the points at each end that is left out, 0 to 0.4
/// @param below  triangles
/// @return       0 to 1
/// @throws Error  as `circular_arc`; on a rim that is straight
double uncovered_share(const Eigen::MatrixX3d& rim, double ends, const TriMesh& below);

}  // namespace geoprior
