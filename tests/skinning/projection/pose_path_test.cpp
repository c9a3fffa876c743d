#include "solvers/skinning/projection/pose_path.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/geometry/procedural.h"
#include "tests/skinning/fixtures.h"

namespace geoprior::skinning {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double angle_at(const Pose& pose, int joint, int parent) {
  const Eigen::Matrix3d turn = pose[parent].linear().transpose() * pose[joint].linear();
  return Eigen::AngleAxisd(turn).angle();
}

TEST(PosePath, TurnsJointsInEqualSteps) {
  const RiggedMesh rig = two_bone_cylinder(fixtures::cylinder_options());
  const int joint = rig.skeleton.index_of("upper");
  const int parent = rig.skeleton.joints[joint].parent;
  PosePath path(rig.skeleton);
  EXPECT_EQ(path.go_to(rest_pose(rig.skeleton.size()), 10 * kDegree), 1);
  const Pose end = fixtures::turned(rig, "upper", "flexion", 75 * kDegree);
  ASSERT_EQ(path.go_to(end, 10 * kDegree), 8);
  const Joint& upper = rig.skeleton.joints[joint];
  for (int step = 1; step <= 8; ++step) {
    const Pose& pose = path.at(step);
    EXPECT_NEAR(angle_at(pose, joint, parent), 75 * kDegree * step / 8, 1e-9);
    EXPECT_LE((pose[joint] * upper.head - upper.head).norm(), 1e-12) << "the joint stays in place";
  }
  EXPECT_EQ(path.at(8)[joint].matrix(), end[joint].matrix());
}

TEST(PosePath, GoesOnFromWhereItIs) {
  const RiggedMesh rig = two_bone_cylinder(fixtures::cylinder_options());
  PosePath path(rig.skeleton);
  path.go_to(rest_pose(rig.skeleton.size()), kDegree);
  EXPECT_EQ(path.go_to(fixtures::turned(rig, "upper", "flexion", 20 * kDegree), 10 * kDegree), 2);
  EXPECT_EQ(path.go_to(fixtures::turned(rig, "upper", "flexion", 15 * kDegree), 10 * kDegree), 1);
  EXPECT_EQ(path.go_to(fixtures::turned(rig, "upper", "flexion", -20 * kDegree), 10 * kDegree), 4);
}

// The whole body is not walked to where it stands.
TEST(PosePath, BeginsAtRestMovedAsAWhole) {
  const RiggedMesh rig = two_bone_cylinder(fixtures::cylinder_options());
  const int joint = rig.skeleton.index_of("upper");
  const int parent = rig.skeleton.joints[joint].parent;
  PosePath path(rig.skeleton);
  Pose away = fixtures::turned(rig, "upper", "flexion", 75 * kDegree);
  const Eigen::Affine3d moved =
      Eigen::Translation3d(3, -2, 1) * Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized());
  for (Eigen::Affine3d& transform : away) transform = moved * transform;
  for (int times = 0; times < 2; ++times) {
    ASSERT_EQ(path.go_to(away, 10 * kDegree), 8);
    for (int step = 1; step <= 8; ++step) {
      const Pose& pose = path.at(step);
      EXPECT_NEAR(angle_at(pose, joint, parent), 75 * kDegree * step / 8, 1e-9);
      EXPECT_LE((pose[parent].matrix() - away[parent].matrix()).norm(), 1e-9);
    }
    path.restart();
  }
}

}  // namespace
}  // namespace geoprior::skinning
