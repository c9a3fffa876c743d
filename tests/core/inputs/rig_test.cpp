#include "core/inputs/rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/geometry/procedural.h"
#include "core/geometry/topology.h"

namespace geoprior {
namespace {

constexpr double kRightAngle = std::numbers::pi / 2;

Skeleton two_link_arm() {
  Skeleton skeleton;
  skeleton.joints.resize(3);
  skeleton.joints[0] = {"root", -1, {0, 0, 0}, Eigen::Vector3d(1, 0, 0), {}};
  skeleton.joints[1] = {"elbow", 0, {1, 0, 0}, Eigen::Vector3d(3, 0, 0), {}};
  skeleton.joints[2] = {"wrist", 1, {3, 0, 0}, {}, {}};
  return skeleton;
}

Eigen::Quaterniond about_z(double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
}

std::string error_of(const Skeleton& skeleton) {
  try {
    validate(skeleton);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

// Planar two-link arm: x = l1 cos a + l2 cos(a + b), y likewise with sines.
TEST(Rig, ForwardKinematicsOfTheTwoLinkArm) {
  const Skeleton skeleton = two_link_arm();
  const double a = 0.7, b = -1.1;
  const Pose pose = pose_from_rotations(skeleton, {{0, about_z(a)}, {1, about_z(b)}}, {0, 0, 5});
  const Eigen::Vector3d wrist = pose[1] * Eigen::Vector3d(3, 0, 0);
  EXPECT_NEAR(wrist.x(), std::cos(a) + 2 * std::cos(a + b), 1e-15);
  EXPECT_NEAR(wrist.y(), std::sin(a) + 2 * std::sin(a + b), 1e-15);
  EXPECT_NEAR(wrist.z(), 5, 1e-15);
  // A joint without rotation moves with its parent.
  EXPECT_LE((pose[2].matrix() - pose[1].matrix()).norm(), 1e-14);
}

TEST(Rig, RotationsOfOneJointMultiplyInOrder) {
  const Skeleton skeleton = two_link_arm();
  const Eigen::Quaterniond x(Eigen::AngleAxisd(kRightAngle, Eigen::Vector3d::UnitX()));
  const Pose pose = pose_from_rotations(skeleton, {{0, x}, {0, about_z(kRightAngle)}});
  // First about z, then about x: x -> y -> z.
  EXPECT_LE((pose[0] * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
}

TEST(Rig, RestPoseIsIdentity) {
  for (const Eigen::Affine3d& transform : rest_pose(4))
    EXPECT_EQ((transform.matrix() - Eigen::Matrix4d::Identity()).norm(), 0);
  EXPECT_EQ(pose_from_rotations(two_link_arm(), {}).size(), 3U);
}

TEST(Rig, RigidPartIsThePolarFactor) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  const Eigen::Matrix3d R = Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  Eigen::Matrix3d stretch;
  stretch << 2, 0.3, 0, 0.3, 1, -0.2, 0, -0.2, 0.5;  // symmetric, positive definite
  transform.linear() = R * stretch;
  transform.translation() << 1, 2, 3;
  EXPECT_LE((rigid_part(transform).linear() - R).norm(), 1e-14);
  EXPECT_LE((rigid_part(transform).translation() - Eigen::Vector3d(1, 2, 3)).norm(), 0);
  transform.linear() = -transform.linear();
  EXPECT_NEAR(rigid_part(transform).linear().determinant(), 1, 1e-14);  // never a reflection
}

TEST(Rig, UnknownJointListsTheNames) {
  try {
    (void)two_link_arm().index_of("knee");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("root, elbow, wrist"), std::string::npos);
  }
  EXPECT_EQ(two_link_arm().index_of("wrist"), 2);
}

TEST(Rig, BadSkeletonsAreRefusedByTheJointsName) {
  EXPECT_EQ(error_of(two_link_arm()), "");
  Skeleton cyclic = two_link_arm();
  cyclic.joints[1].parent = 2;
  EXPECT_NE(error_of(cyclic).find("elbow"), std::string::npos);
  Skeleton twice = two_link_arm();
  twice.joints[2].name = "elbow";
  EXPECT_NE(error_of(twice).find("elbow"), std::string::npos);
  Skeleton pointless = two_link_arm();
  pointless.joints[0].tail = pointless.joints[0].head;
  EXPECT_NE(error_of(pointless).find("root"), std::string::npos);
  Skeleton skewed = two_link_arm();
  skewed.joints[1].axes["flexion"] = {1, 1, 0};
  EXPECT_NE(error_of(skewed).find("flexion"), std::string::npos);
  Skeleton nan = two_link_arm();
  nan.joints[2].head.x() = std::nan("");
  EXPECT_NE(error_of(nan).find("wrist"), std::string::npos);
}

TEST(Rig, BadWeightsAreRefusedByTheVertex) {
  RiggedMesh rig = capsule_finger();
  const int n = rig.mesh.vertex_count();
  EXPECT_NO_THROW(validate(rig.weights, n, 4));
  EXPECT_THROW(validate(rig.weights, n + 1, 4), Error);
  for (const double bad : {-0.1, 0.3, std::nan("")}) {
    SkinWeights weights = rig.weights;
    weights.coeffRef(17, 0) = bad;
    try {
      validate(weights, n, 4);
      FAIL() << bad;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("vertex 17"), std::string::npos);
    }
  }
}

TEST(Procedural, CylinderIsClosedAndConvergesToItsVolume) {
  CylinderOptions options;
  options.segments = 200;
  options.cap_height = 0;
  const RiggedMesh rig = two_bone_cylinder(options);
  EXPECT_NO_THROW(require_closed_manifold(rig.mesh, "test", "cylinder"));
  EXPECT_NO_THROW(validate(rig.skeleton));
  EXPECT_NO_THROW(validate(rig.weights, rig.mesh.vertex_count(), 2));
  const double exact = std::numbers::pi * options.radius * options.radius * 2 * options.half_length;
  // Staggered rings: the prism's deficit 1 - sin(x)/x cos(x/2), x = 2 pi / 200, is below 5e-4.
  EXPECT_NEAR(signed_volume(rig.mesh.V, rig.mesh.F) / exact, 1, 5e-4);
}

TEST(Procedural, CylinderWeightsAreTheRamp) {
  const CylinderOptions options;
  const RiggedMesh rig = two_bone_cylinder(options);
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const double ramp = std::clamp(0.5 + rig.mesh.V(v, 0) / options.ramp_width, 0.0, 1.0);
    EXPECT_NEAR(rig.weights.coeff(v, 1), ramp, 1e-15);
  }
  ASSERT_EQ(mid_ring(options).size(), static_cast<std::size_t>(options.segments));
  for (const int v : mid_ring(options)) {
    EXPECT_EQ(rig.mesh.V(v, 0), 0);
    EXPECT_EQ(rig.weights.coeff(v, 0), 0.5);
    EXPECT_EQ(rig.weights.coeff(v, 1), 0.5);
  }
}

TEST(Procedural, FingerIsClosedAndCurlsTowardsThePalm) {
  const RiggedMesh finger = capsule_finger();
  EXPECT_NO_THROW(require_closed_manifold(finger.mesh, "test", "finger"));
  EXPECT_NO_THROW(validate(finger.skeleton));
  EXPECT_NO_THROW(validate(finger.weights, finger.mesh.vertex_count(), 4));
  EXPECT_GT(signed_volume(finger.mesh.V, finger.mesh.F), 0);
  std::vector<JointRotation> curl;
  for (int j = 1; j < 4; ++j)
    curl.push_back({j, Eigen::Quaterniond(
                           Eigen::AngleAxisd(0.5, finger.skeleton.joints[j].axes.at("flexion")))});
  const Eigen::Vector3d tip =
      pose_from_rotations(finger.skeleton, curl)[3] * *finger.skeleton.joints[3].tail;
  EXPECT_LT(tip.z(), -0.02);
  EXPECT_NEAR(tip.y(), 0, 1e-16);
}

TEST(Procedural, WrongOptionsAreRefused) {
  EXPECT_THROW(two_bone_cylinder({.radius = 0}), Error);
  EXPECT_THROW(two_bone_cylinder({.segments = 2}), Error);
  EXPECT_THROW(capsule_finger({.phalanx_length = {0.04, 0, 0.02}}), Error);
}

}  // namespace
}  // namespace geoprior
