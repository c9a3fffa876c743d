#include "solvers/skinning/base/base_skin.h"

namespace geoprior::skinning {

BaseSkin::Skin BaseSkin::made(const RiggedMesh& rig, BaseKind kind) {
  switch (kind) {
    case BaseKind::centers_of_rotation:
      return CentersOfRotation(rig);
    case BaseKind::direct_delta_mush:
      return DirectDeltaMush(rig);
    case BaseKind::limbs_and_trunk:
    case BaseKind::dual_quaternion:
      break;
  }
  return DualQuaternionBlend(rig);
}

BaseSkin::BaseSkin(const RiggedMesh& rig, BaseKind kind, const Eigen::VectorXd& limb_share)
    : skin_(made(rig, kind)) {
  if (kind != BaseKind::limbs_and_trunk || (limb_share.array() >= 1).all()) return;
  trunk_.emplace(rig);
  limb_share_ = limb_share;
}

void BaseSkin::deform(const Pose& pose, Eigen::MatrixX3d& posed) {
  std::visit([&](const auto& skin) { skin.deform(pose, posed); }, skin_);
  if (!trunk_) return;
  // As dual quaternions do: what is not rigid is dropped.
  rigid_.resize(pose.size());
  for (std::size_t j = 0; j < pose.size(); ++j) {
    rigid_[j] = pose[j];
    rigid_[j].linear() = rigid_part(pose[j]).linear();
  }
  trunk_->deform(rigid_, trunk_posed_);
  posed = trunk_posed_ + limb_share_.asDiagonal() * (posed - trunk_posed_);
}

}  // namespace geoprior::skinning
