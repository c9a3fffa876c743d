#include "solvers/skinning/projection/pose_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>

#include "core/error.h"

namespace geoprior::skinning {
namespace {

/// Of a first pose: what a joint may be turned (radians) and carried away (m) by the round-off of
/// files.
constexpr double kTurnAtRest = 0.1 * std::numbers::pi / 180;
constexpr double kAwayAtRest = 1e-4;

double angle_of(const Eigen::Matrix3d& rotation) { return Eigen::AngleAxisd(rotation).angle(); }

std::string short_number(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", x);
  return text.data();
}

}  // namespace

PosePath::PosePath(Skeleton skeleton) : skeleton_(std::move(skeleton)) {}

Eigen::Isometry3d PosePath::against_parent(const Pose& pose, std::size_t joint) const {
  const int parent = skeleton_.joints[joint].parent;
  const Eigen::Isometry3d own = rigid_part(pose[joint]);
  return parent < 0 ? own : rigid_part(pose[parent]).inverse() * own;
}

int PosePath::go_to(const Pose& pose, double largest_turn) {
  if (!begun_) {
    double farthest = 1;
    std::string turned;
    for (std::size_t j = 0; j < pose.size(); ++j) {
      const Joint& joint = skeleton_.joints[j];
      if (joint.parent < 0) continue;
      const Eigen::Isometry3d local = against_parent(pose, j);
      const double angle = angle_of(local.linear());
      const double away = (local * joint.head - joint.head).norm();
      const double off = std::max(angle / kTurnAtRest, away / kAwayAtRest);
      if (off <= farthest) continue;
      farthest = off;
      turned = "joint '" + joint.name + "' is turned by " +
               short_number(angle * 180 / std::numbers::pi) + " degrees and moved by " +
               short_number(1000 * away) + " mm against its parent";
    }
    if (!turned.empty()) {
      throw Error("the poses begin away from rest: " + turned,
                  "implicit skinning that tracks contact", "a motion that begins in the rest pose");
    }
    from_ = pose;
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
