#include "baselines/skinning/shared/rigid_joints.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <string>

#include "core/error.h"

namespace geoprior::skinning {

void require_finite_pose(const Pose& pose, int joints, std::string_view who) {
  if (std::ssize(pose) != joints) {
    throw Error("pose of " + std::to_string(pose.size()) + " transforms", std::string(who),
                std::to_string(joints));
  }
  for (std::size_t j = 0; j < pose.size(); ++j) {
    if (!pose[j].matrix().allFinite())
      throw Error("transform is not finite", "joint " + std::to_string(j) + " of the pose");
  }
}

Eigen::Matrix3d rotation_of(const Eigen::Affine3d& transform) {
  Eigen::Matrix3d R = transform.linear();
  for (int step = 0; step < 3; ++step) {
    const double error = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!(error < 1e-3) || R.determinant() < 0) break;
    if (error < 1e-14) return R;
    R = 0.5 * (R + Eigen::Matrix3d(R.inverse().transpose()));
    if (error < 1e-7) return R;
  }
  return rigid_part(transform).linear();
}

}  // namespace geoprior::skinning
