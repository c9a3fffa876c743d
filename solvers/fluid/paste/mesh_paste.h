#pragma once

#include "core/inputs/surface_sequence.h"
#include "solvers/fluid/edits.h"
#include "solvers/fluid/feature.h"

namespace geoprior::fluid {

/// Mesh of an isolated feature in the target: that of the nearest frame, carried along the path;
/// outward oriented after a mirror too.
TriMesh isolated_at(const Feature& feature, const EditedFrame& frame);

/// Adds a mesh beside the target's triangles; they may overlap. All of its vertices move with
/// `velocity` (m/s) when the target's velocities are known.
void insert_mesh(const TriMesh& mesh, const Eigen::Vector3d& velocity, SurfaceFrame& target);

/// Exact union of the target and a closed mesh (CGAL: corefinement, exact predicates).
/// `of_target` and `of_mesh` are given per vertex of the result: the vertex it was, or -1 both for
/// those on the intersection. Their velocity is the mean of their neighbours'.
/// @return false, and the target as it was, when one of them bounds no volume or cuts itself
bool unite_mesh(const TriMesh& mesh, const Eigen::Vector3d& velocity, SurfaceFrame& target,
                std::vector<int>& of_target, std::vector<int>& of_mesh);

}  // namespace geoprior::fluid
