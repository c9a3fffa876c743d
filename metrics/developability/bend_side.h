#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/inputs/skeleton.h"
#include "metrics/contact/joint_region.h"

namespace geoprior {

/// Which way is out of a bend, across each of a hinge's bones: away from where the limbs meet.
struct BendSides {
  double sign = 1;           ///< of the turn about the hinge's bend axis; +1 at rest
  Eigen::Vector3d proximal;  ///< unit, rest, orthogonal to the parent's bone
  Eigen::Vector3d distal;    ///< unit, rest, orthogonal to the joint's own bone
};

/// Absent where the motion has no single axis, or one along a bone (a twist).
std::optional<BendSides> bend_sides(const JointRegion::Hinge& hinge, const Pose& pose);

/// Vertices of the region on the outer side of the hinge whose joint they lie nearest to at rest;
/// ascending. Vertices of a hinge without sides are left out.
/// @param rest  n x 3 (m), the mesh's vertices
std::vector<int> outer_vertices(const JointRegion& region, const Eigen::MatrixX3i& F,
                                const Eigen::MatrixX3d& rest, const Pose& pose);

}  // namespace geoprior
