#pragma once

#include <Eigen/Core>

#include "baselines/skinning/shared/influences.h"
#include "core/inputs/rig.h"

namespace geoprior::skinning {

/// Linear blend skinning: v' = (sum_j w_j T_j) v.
///
/// Fast and general (any affine transform, any number of influences), but the blend of two
/// rotations is no rotation: a twist by theta shrinks a tube to r |cos(theta/2)| (candy wrapper)
/// and a bend makes its mid-ring an ellipse of half axes r cos(theta/2) and r (collapsing elbow).
/// Nothing prevents self-contact.
///
/// This is the formula, one vertex and one influence at a time. `LinearBlend` computes the same
/// four vertices at a time and is what experiments run.
///
/// @param rig   mesh of n vertices, skeleton of m joints, weights n x m
/// @param pose  m transforms
/// @return      posed positions, n x 3 (m)
/// @throws Error  unless `pose` has m transforms
/// Source: Magnenat-Thalmann et al. 1988; thesis 3.1.
Eigen::MatrixX3d linear_blend(const RiggedMesh& rig, const Pose& pose);

/// `linear_blend` for many poses of one rig: influences are packed once, and vertices taken four at
/// a time (linear_blend_lanes.h) by several threads.
///
/// Weights are stored as floats, so that results differ from the formula by rounding of the
/// weights, 6e-8 times the distances between a vertex's images under its joints.
class LinearBlend {
 public:
  /// @param rig  welded mesh of n vertices, skeleton of m joints, weights n x m (validated; throws
  /// Error)
  explicit LinearBlend(const RiggedMesh& rig);

  /// Writes the posed positions (n x 3, metres); resizes `posed` when needed, allocates nothing
  /// otherwise.
  /// @throws Error  unless `pose` has m transforms
  void deform(const Pose& pose, Eigen::MatrixX3d& posed) const;

  [[nodiscard]] const PackedInfluences& influences() const { return influences_; }

 private:
  PackedInfluences influences_;
};

}  // namespace geoprior::skinning
