#pragma once

#include <Eigen/Core>
#include <vector>

#include "baselines/skinning/centers_of_rotation/integral.h"
#include "baselines/skinning/shared/influences.h"
#include "core/inputs/rig.h"

namespace geoprior::skinning {

/// Skinning about given centers p*: with q_j the rotation and (R_j, t_j) the transform of joint j,
///
///   R  = rotation of sum_j w_j s_j q_j,  s_j = +-1 the shorter way from the strongest influence
///   v' = R (v - p*) + sum_j w_j (R_j p* + t_j)
///
/// The formula, one vertex and one influence at a time; `CentersOfRotation` computes the same four
/// vertices at a time.
///
/// @param centers  n x 3 (m)
/// @throws Error  unless `pose` has m transforms, all finite, and there are n centers
Eigen::MatrixX3d blend_about_centers(const RiggedMesh& rig, const Eigen::MatrixX3d& centers,
                                     const Pose& pose);

/// Skinning with optimised centers of rotation: centers once, then a pose costs one linear blend
/// (of the centers) and one blend of quaternions.
///
/// The center of a limb's ring lies on the limb's axis, so that a twist keeps the ring's radius, as
/// dual quaternions do; but the ring is carried by the linear blend of its center, which does not
/// run on a circle about the joint: less bulge outside a bend. For the same reason the two sides
/// inside a bend meet earlier than with dual quaternions. Nothing prevents self-contact.
///
/// Limits: the rotation of a transform that is not rigid is blended without its scale and shear
/// (a vertex with one influence follows it exactly); two joints more than 180 degrees apart turn
/// the shorter way, as with dual quaternions. Limbs that share their joints and weights share their
/// centers too: both legs' rings about one pelvis are averaged where only pelvis and spine act.
///
/// Source: Le and Hodgins 2016.
class CentersOfRotation {
 public:
  /// @param rig  welded mesh of n vertices, skeleton of m joints, weights n x m (validated; throws
  /// Error)
  explicit CentersOfRotation(const RiggedMesh& rig, const CentersOfRotationOptions& options = {});

  /// Writes the posed positions (n x 3, metres); resizes `posed` when needed, allocates nothing
  /// otherwise (beyond 256 joints: one table of their transforms).
  /// @throws Error  unless `pose` has m transforms, all finite
  void deform(const Pose& pose, Eigen::MatrixX3d& posed) const;

  /// n x 3 (m).
  [[nodiscard]] const Eigen::MatrixX3d& centers() const { return centers_; }
  /// Of the centers: what linear blending carries.
  [[nodiscard]] const PackedInfluences& influences() const { return influences_; }

 private:
  Eigen::MatrixX3d centers_;
  PackedInfluences influences_;
  std::vector<double> arms_;  ///< v - p*, packed as `influences_.rest`
};

}  // namespace geoprior::skinning
