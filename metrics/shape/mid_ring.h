#pragma once

#include <Eigen/Core>
#include <vector>

#include "metrics/contact/joint_region.h"

namespace geoprior {

/// Vertices of the ring of a tube in the plane through a joint orthogonal to its bones: those whose
/// rest position lies in that plane and at one distance from the joint, both within 1e-9 radii.
///
/// Empty unless the bones are straight and there are at least eight such vertices: only a tube made
/// by formula has a mid-ring.
std::vector<int> find_mid_ring(const JointRegion::Hinge& hinge, const Eigen::MatrixX3d& rest,
                               const std::vector<int>& vertices);

/// Half axes of the ring's ellipse about the joint, relative to the rest radius.
///
/// They are the square roots of the two larger eigenvalues of sum (x - joint)(x - joint)^T, over
/// that at rest: exact for every linear image of a regular ring, wherever its vertices stand on the
/// ellipse. Closed forms: linear blending by half weights gives cos(theta/2) twice under a twist
/// and cos(theta/2), 1 under a bend; dual quaternions give 1, 1.
struct RingRatio {
  double min = 1;
  double max = 1;
};
/// @throws Error  on an empty ring
RingRatio ring_radius_ratio(const Eigen::MatrixX3d& rest, const Eigen::Vector3d& rest_joint,
                            const Eigen::MatrixX3d& posed, const Eigen::Vector3d& posed_joint,
                            const std::vector<int>& ring);

}  // namespace geoprior
