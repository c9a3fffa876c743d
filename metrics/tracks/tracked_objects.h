#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"
#include "metrics/tracks/scores.h"

namespace geoprior {

/// Objects of one frame whose vertices carry the id of their track: centre, weighted by the area of
/// the triangles about each vertex, and box.
///
/// Where two tracks meet, a triangle gives each of its corners its whole area.
/// @param track  id of every vertex; 0: of none
/// @param kind   of every vertex; an object has the kind of the last of its vertices
/// @return       by id
std::vector<TrackedObject> tracked_objects(const TriMesh& surface,
                                           const Eigen::Ref<const Eigen::VectorXd>& track,
                                           const Eigen::Ref<const Eigen::VectorXd>& kind);

}  // namespace geoprior
