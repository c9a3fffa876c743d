#include "solvers/skinning/projection/pose_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace geoprior::skinning {
namespace {

double angle_of(const Eigen::Matrix3d& rotation) { return Eigen::AngleAxisd(rotation).angle(); }

}  // namespace

PosePath::PosePath(Skeleton skeleton) : skeleton_(std::move(skeleton)) {}

Eigen::Isometry3d PosePath::against_parent(const Pose& pose, std::size_t joint) const {
  const int parent = skeleton_.joints[joint].parent;
  const Eigen::Isometry3d own = rigid_part(pose[joint]);
  return parent < 0 ? own : rigid_part(pose[parent]).inverse() * own;
}

int PosePath::go_to(const Pose& pose, double largest_turn) {
  if (!begun_) {
    // All joints where they are at rest against the first one, which is a root.
    const Eigen::Affine3d whole(rigid_part(pose.front()));
    from_.assign(pose.size(), whole);
    begun_ = true;
  } else {
    std::swap(from_, to_);
  }
  to_ = pose;
  double largest = 0;
  for (std::size_t j = 0; j < pose.size(); ++j) {
    const Eigen::Matrix3d turn =
        against_parent(from_, j).linear().transpose() * against_parent(to_, j).linear();
    largest = std::max(largest, angle_of(turn));
  }
  steps_ = std::max(1, static_cast<int>(std::ceil(largest / largest_turn - 1e-9)));
  return steps_;
}

const Pose& PosePath::at(int step) {
  if (step >= steps_) return to_;
  const double share = static_cast<double>(step) / steps_;
  between_.resize(to_.size());
  for (std::size_t j = 0; j < to_.size(); ++j) {
    const Joint& joint = skeleton_.joints[j];
    const Eigen::Isometry3d a = against_parent(from_, j), b = against_parent(to_, j);
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(a.linear()).slerp(share, Eigen::Quaterniond(b.linear()));
    const Eigen::Vector3d head = (1 - share) * (a * joint.head) + share * (b * joint.head);
    Eigen::Isometry3d local = Eigen::Isometry3d::Identity();
    local.linear() = turn.toRotationMatrix();
    local.translation() = head - local.linear() * joint.head;
    between_[j] =
        joint.parent < 0 ? Eigen::Affine3d(local) : between_[joint.parent] * Eigen::Affine3d(local);
  }
  return between_;
}

}  // namespace geoprior::skinning
