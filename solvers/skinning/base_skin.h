#pragma once

#include <Eigen/Core>
#include <variant>

#include "baselines/skinning/centers_of_rotation/centers_of_rotation.h"
#include "baselines/skinning/direct_delta_mush/direct_delta_mush.h"
#include "baselines/skinning/dual_quaternion/dual_quaternion.h"
#include "core/inputs/rig.h"
#include "solvers/skinning/implicit_options.h"

namespace geoprior::skinning {

/// The skin that implicit skinning corrects: one of the methods that blend the motion of joints.
class BaseSkin {
 public:
  BaseSkin(const RiggedMesh& rig, BaseKind kind);

  /// Writes the posed positions (n x 3, metres); as of the method itself.
  void deform(const Pose& pose, Eigen::MatrixX3d& posed) const {
    std::visit([&](const auto& skin) { skin.deform(pose, posed); }, skin_);
  }

 private:
  using Skin = std::variant<DualQuaternionBlend, CentersOfRotation, DirectDeltaMush>;
  static Skin made(const RiggedMesh& rig, BaseKind kind);

  Skin skin_;
};

}  // namespace geoprior::skinning
