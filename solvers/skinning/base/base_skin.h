#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

#include "baselines/skinning/centers_of_rotation/centers_of_rotation.h"
#include "baselines/skinning/direct_delta_mush/direct_delta_mush.h"
#include "baselines/skinning/dual_quaternion/dual_quaternion.h"
#include "core/inputs/rig.h"
#include "solvers/skinning/implicit_options.h"

namespace geoprior::skinning {

/// The skin that implicit skinning corrects: one of the methods that blend the motion of joints, or
/// dual quaternions on limbs and centers of rotation on the trunk. Dual quaternions carry skin on a
/// circle about the joint, which keeps the volume of a limb, and of a trunk, whose skin is far from
/// the joint, swings out what hangs on it; centers of rotation turn it about its own middle.
class BaseSkin {
 public:
  /// @param limb_share  of each vertex: 1 on limbs, 0 on the trunk
  BaseSkin(const RiggedMesh& rig, BaseKind kind, const Eigen::VectorXd& limb_share);

  /// Writes the posed positions (n x 3, metres); as of the method itself.
  void deform(const Pose& pose, Eigen::MatrixX3d& posed);

 private:
  using Skin = std::variant<DualQuaternionBlend, CentersOfRotation, DirectDeltaMush>;
  static Skin made(const RiggedMesh& rig, BaseKind kind);

  Skin skin_;
  std::optional<CentersOfRotation> trunk_;  ///< where two methods share the skin
  Eigen::VectorXd limb_share_;
  Pose rigid_;
  Eigen::MatrixX3d trunk_posed_;
};

}  // namespace geoprior::skinning
