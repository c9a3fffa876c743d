#include "solvers/skinning/base_skin.h"

namespace geoprior::skinning {

BaseSkin::Skin BaseSkin::made(const RiggedMesh& rig, BaseKind kind) {
  switch (kind) {
    case BaseKind::centers_of_rotation:
      return CentersOfRotation(rig);
    case BaseKind::direct_delta_mush:
      return DirectDeltaMush(rig);
    case BaseKind::dual_quaternion:
      break;
  }
  return DualQuaternionBlend(rig);
}

BaseSkin::BaseSkin(const RiggedMesh& rig, BaseKind kind) : skin_(made(rig, kind)) {}

}  // namespace geoprior::skinning
