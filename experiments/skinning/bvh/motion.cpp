#include "experiments/skinning/bvh/motion.h"

#include <numbers>

namespace geoprior::skinning {

std::vector<Eigen::Vector3d> rest_positions(const BvhMotion& motion) {
  std::vector<Eigen::Vector3d> positions;
  for (const BvhJoint& joint : motion.joints) {
    const Eigen::Vector3d offset = motion.to_y_up * joint.offset;
    positions.push_back(joint.parent < 0 ? offset
                                         : Eigen::Vector3d(positions[joint.parent] + offset));
  }
  return positions;
}

BvhFrame bvh_frame(const BvhMotion& motion, int frame) {
  BvhFrame result;
  for (const BvhJoint& joint : motion.joints) {
    Eigen::Quaterniond local = Eigen::Quaterniond::Identity();
    Eigen::Vector3d offset = joint.offset;
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    for (int c = 0; c < std::ssize(joint.channels); ++c) {
      const double x = motion.values(frame, joint.first_column + c);
      const int axis = joint.channels[c].axis;
      if (joint.channels[c].is_rotation) {
        local = local * Eigen::AngleAxisd(x * std::numbers::pi / 180, Eigen::Vector3d::Unit(axis));
      } else {
        moved[axis] += x;
        if (joint.channels_hold_offset) offset[axis] = 0;
      }
    }
    if (joint.parent < 0) {
      result.rotation.push_back(local);
      result.position.push_back(offset + moved);
    } else {
      const std::size_t p = joint.parent;
      result.position.push_back(result.position[p] + result.rotation[p] * (offset + moved));
      result.rotation.push_back((result.rotation[p] * local).normalized());
    }
  }
  for (Eigen::Quaterniond& rotation : result.rotation)
    rotation = motion.to_y_up * rotation * motion.to_y_up.conjugate();
  for (Eigen::Vector3d& position : result.position) position = motion.to_y_up * position;
  return result;
}

}  // namespace geoprior::skinning
