#pragma once

#include <Eigen/Core>

#include "baselines/skinning/shared/influences.h"
#include "core/inputs/rig.h"

namespace geoprior::skinning {

/// Dual quaternion linear blending: v' = (b / |b|) v (b / |b|)*, b = sum_j w_j s_j q_j.
///
/// q_j is the unit dual quaternion of joint j's rigid transform and s_j = +-1. The blend of rigid
/// transforms is rigid again, so that twisted tubes keep their radius and bent ones their mid-ring
/// (no candy wrapper, no collapsing elbow); instead the outside of a bent joint bulges: vertices
/// turn on circles about the joint. Nothing prevents self-contact.
///
/// Antipodality: q and -q are the same transform, but blend differently. s_j is the sign of
/// q_j . q_p, p being the vertex's own strongest influence: every vertex then takes the shorter way
/// from the transform that dominates it, whatever signs the conversion from matrices left and
/// however far the chain before it has turned. A pivot common to all vertices would fail beyond
/// 180 degrees between the pivot and a joint far from it.
///
/// Limit: the shorter way is a convention. When two joints of a vertex differ by more than 180
/// degrees, the blend runs the other way round, and near 180 degrees it jumps (q_j . q_p = 0).
/// A pose holds no number of turns, so no blending of transforms can do better; distribute a larger
/// twist over several joints.
///
/// With b = r + eps e the posed position is (r / |r|) v (r / |r|)* + 2 vec(e r*) / |r|^2.
///
/// A transform that is not rigid is replaced by its rotation (polar decomposition) about the
/// image of the joint's head: scale and shear are lost, the bone stays attached.
///
/// This is the formula, one vertex and one influence at a time. `DualQuaternionBlend` computes the
/// same four vertices at a time and is what experiments run.
///
/// @param rig   mesh of n vertices, skeleton of m joints, weights n x m
/// @param pose  m transforms
/// @return      posed positions, n x 3 (m)
/// @throws Error  unless `pose` has m transforms, all finite
/// Source: Kavan, Collins, Žára, O'Sullivan 2007/2008; thesis 3.1.
Eigen::MatrixX3d dual_quaternion_blend(const RiggedMesh& rig, const Pose& pose);

/// `dual_quaternion_blend` for many poses of one rig: influences are packed once, and vertices
/// taken four at a time (dual_quaternion_lanes.h) by several threads. Weights are stored as floats,
/// whose rounding is the difference from the formula.
class DualQuaternionBlend {
 public:
  /// @param rig  welded mesh of n vertices, skeleton of m joints, weights n x m (validated; throws
  /// Error)
  explicit DualQuaternionBlend(const RiggedMesh& rig);

  /// Writes the posed positions (n x 3, metres); resizes `posed` when needed, allocates nothing
  /// otherwise (beyond 256 joints: one table of their dual quaternions).
  /// @throws Error  unless `pose` has m transforms, all finite
  void deform(const Pose& pose, Eigen::MatrixX3d& posed) const;

  [[nodiscard]] const PackedInfluences& influences() const { return influences_; }

 private:
  PackedInfluences influences_;
  std::vector<Eigen::Vector3d> heads_;
};

}  // namespace geoprior::skinning
