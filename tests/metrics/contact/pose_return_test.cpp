#include "metrics/contact/pose_return.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"

namespace geoprior {
namespace {

Pose turned(double angle) {
  Pose pose = rest_pose(2);
  pose[1].rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()));
  return pose;
}

const Eigen::MatrixX3d kAt = Eigen::MatrixX3d::Zero(3, 3);

TEST(InBoneFrame, OfSkinThatMovesWithItsBonesIsTheRestPose) {
  Eigen::MatrixX3d rest(3, 3);
  rest << 0, 1, 0, 0, 2, 1, 1, 0, 2;
  SkinWeights weights(3, 2);
  weights.insert(0, 0) = 1;
  weights.insert(1, 0) = 0.4;
  weights.insert(1, 1) = 0.6;
  weights.insert(2, 0) = 0.5;  // of equals the first
  weights.insert(2, 1) = 0.5;
  const Pose pose = turned(0.8);
  Eigen::MatrixX3d posed = rest;
  posed.row(1) = (pose[1] * Eigen::Vector3d(rest.row(1))).transpose();
  EXPECT_TRUE(in_bone_frame(weights, pose, posed).isApprox(rest, 1e-12));
  posed(2, 2) += 0.1;
  EXPECT_NEAR((in_bone_frame(weights, pose, posed) - rest).norm(), 0.1, 1e-12);
}

TEST(PoseReturn, IsTheLargestDistanceOverTheRadius) {
  Eigen::MatrixX3d off = kAt;
  off(0, 1) = 0.02;  // a fifth of its radius
  off(1, 2) = 0.03;  // a tenth
  off(2, 0) = 9;     // without a radius
  const Eigen::Vector3d radius(0.1, 0.3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_NEAR(pose_return({kAt, 5 * off, off}, {turned(0), turned(0.5), turned(0)}, radius).value(),
              0.2, 1e-12);
  EXPECT_EQ(pose_return({kAt, off, kAt}, {turned(0), turned(0.5), turned(0)}, radius), 0);
}

TEST(PoseReturn, IsAbsentWhenNoPoseComesTwice) {
  const Eigen::Vector3d radius = Eigen::Vector3d::Ones();
  EXPECT_FALSE(pose_return({kAt, kAt}, {turned(0), turned(1e-6)}, radius).has_value());
  EXPECT_FALSE(pose_return({}, {}, radius).has_value());
}

TEST(PoseReturn, NeedsAPoseAFrame) {
  EXPECT_THROW((void)pose_return({kAt}, {}, Eigen::Vector3d::Ones()), Error);
}

}  // namespace
}  // namespace geoprior
