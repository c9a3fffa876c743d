#include "experiments/skinning/bvh/up.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "testbed/runner/number_text.h"

namespace geoprior::skinning {
namespace {

constexpr double kStands = 0.3;  ///< agreement of heights from which a body stands
constexpr double kFlat = 0.01;   ///< variance across a line, of that along it

/// Driven joints of the character at rest, and the joints of the motion that drive them.
struct DrivenJoints {
  std::vector<int> ours;
  std::vector<int> theirs;
};

DrivenJoints driven_joints(const BvhMotion& motion, const SkeletonFile& skeleton) {
  DrivenJoints joints;
  for (int j = 0; j < skeleton.skeleton.size(); ++j) {
    for (int b = 0; b < std::ssize(motion.joints); ++b) {
      if (skeleton.bvh_joint[j] != motion.joints[b].name) continue;
      joints.ours.push_back(j);
      joints.theirs.push_back(b);
    }
  }
  return joints;
}

/// Whether the joints say which way is up: they have height, and are no line.
bool tells_up(const SkeletonFile& skeleton, const DrivenJoints& joints) {
  if (joints.ours.size() < 3) return false;
  Eigen::MatrixX3d heads(joints.ours.size(), 3);
  for (std::size_t i = 0; i < joints.ours.size(); ++i)
    heads.row(i) = skeleton.skeleton.joints[joints.ours[i]].head;
  const Eigen::MatrixX3d centred = heads.rowwise() - heads.colwise().mean();
  const Eigen::Matrix3d covariance = centred.transpose() * centred;
  const Eigen::Vector3d spread =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues();
  return spread[1] > kFlat * spread[2] && covariance(1, 1) > kFlat * covariance.trace();
}

BvhMotion turned(BvhMotion motion, int up) {
  motion.to_y_up =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::Unit(up), Eigen::Vector3d::UnitY());
  return motion;
}

/// Covariance of the heights h of the character's driven joints with those of the motion's joints
/// at x, over the sizes of both, |h| |x|: 1 for a body of the same heights that is nothing but
/// high, 0 for one that lies. (A correlation of heights alone would take the depth of a chest for a
/// height.)
double agreement(const SkeletonFile& skeleton, const DrivenJoints& joints,
                 const std::vector<Eigen::Vector3d>& positions) {
  const Eigen::Index n = joints.ours.size();
  Eigen::VectorXd heights(n);
  Eigen::MatrixX3d places(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    heights[i] = skeleton.skeleton.joints[joints.ours[i]].head.y();
    places.row(i) = positions[joints.theirs[i]];
  }
  heights.array() -= heights.mean();
  places.rowwise() -= Eigen::RowVector3d(places.colwise().mean());
  const double sizes = heights.norm() * places.norm();
  return sizes > 0 && std::isfinite(sizes) ? heights.dot(places.col(1)) / sizes : 0;
}

/// How well the body stands: the better agreement of the two that count.
double standing(const BvhMotion& upright, const SkeletonFile& skeleton, const DrivenJoints& joints,
                int origin_frame) {
  return std::max(agreement(skeleton, joints, rest_positions(upright)),
                  agreement(skeleton, joints, bvh_frame(upright, origin_frame).position));
}

[[noreturn]] void refuse(const std::array<double, 3>& score, int up, const std::string& name) {
  std::string scores;
  for (int axis = 0; axis < 3; ++axis) {
    scores += std::string(axis == 0 ? "" : ", ") + "\"" + "xyz"[axis] + "\" " +
              rounded_text(score[axis], 2);
  }
  const std::string axis(1, "xyz"[up]);
  const bool upside_down = score[up] < -kStands;
  throw Error("with bvh_up = \"" + axis + "\" the body would " +
                  (upside_down ? "stand on its head" : "lie down") +
                  ": its joints' heights agree with those of the motion by " +
                  rounded_text(score[up], 2),
              name, "0.3 or more; bvh_up: " + scores);
}

}  // namespace

BvhMotion stand_up(BvhMotion motion, const SkeletonFile& skeleton, BvhUp up, int origin_frame,
                   const std::string& name) {
  constexpr int kY = 1;
  const int named = up == BvhUp::guess ? kY : static_cast<int>(up) - static_cast<int>(BvhUp::x);
  const DrivenJoints joints = driven_joints(motion, skeleton);
  if (!tells_up(skeleton, joints)) return turned(std::move(motion), named);
  std::array<double, 3> score{};
  for (int axis = 0; axis < 3; ++axis)
    score[axis] = standing(turned(motion, axis), skeleton, joints, origin_frame);
  int chosen = named;
  if (up == BvhUp::guess && score[kY] < kStands) {
    chosen = static_cast<int>(std::max_element(score.begin(), score.end()) - score.begin());
  }
  if (score[chosen] < kStands) refuse(score, chosen, name);
  if (chosen != named) {
    motion.notes.push_back(name + ": guessed bvh_up = \"" + "xyz"[chosen] +
                           "\": heights of the joints agree by " + rounded_text(score[chosen], 2) +
                           ", with \"y\" by " + rounded_text(score[kY], 2));
  }
  return turned(std::move(motion), chosen);
}

}  // namespace geoprior::skinning
