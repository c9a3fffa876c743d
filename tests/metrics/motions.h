#pragma once

#include <Eigen/Geometry>

#include "core/inputs/rig.h"

/// Deformations with a known answer.
namespace geoprior::motions {

/// Positions under v' = sum_j w_j T_j v: the closed forms of a bent and a twisted tube.
inline Eigen::MatrixX3d linear_blend(const RiggedMesh& rig, const Pose& pose) {
  Eigen::MatrixX3d posed(rig.mesh.V.rows(), 3);
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (SkinWeights::InnerIterator it(rig.weights, v); it; ++it) {
      sum += it.value() * (pose[it.col()] * rig.mesh.V.row(v).transpose());
    }
    posed.row(v) = sum.transpose();
  }
  return posed;
}

/// Joint 1 of a two-bone tube turned about an axis through the origin.
inline Pose turned(double angle, const Eigen::Vector3d& axis) {
  Pose pose = rest_pose(2);
  pose[1].linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  return pose;
}

/// Weights of a two-bone tube without a blend: the skin follows the nearer bone.
inline void make_rigid(RiggedMesh& rig) {
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const bool upper = rig.mesh.V(v, 0) >= 0;
    rig.weights.coeffRef(v, 0) = upper ? 0 : 1;
    rig.weights.coeffRef(v, 1) = upper ? 1 : 0;
  }
}

}  // namespace geoprior::motions
