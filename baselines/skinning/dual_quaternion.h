#pragma once

#include <Eigen/Core>

#include "baselines/skinning/influences.h"
#include "core/rig.h"

namespace geoprior {

/// Dual quaternion linear blending (Kavan et al. 2007). See the header of the owner for equations
/// and limits.
class DualQuaternionBlend {
 public:
  explicit DualQuaternionBlend(const RiggedMesh& rig);
  void deform(const Pose& pose, Eigen::MatrixX3d& posed) const;

 private:
  PackedInfluences influences_;
};

}  // namespace geoprior
