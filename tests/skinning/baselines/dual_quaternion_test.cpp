#include "baselines/skinning/dual_quaternion/dual_quaternion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angles.h"
#include "core/error.h"
#include "core/parallel.h"
#include "tests/skinning/fixtures.h"

namespace geoprior::skinning {
namespace {

using fixtures::cylinder_options;

/// A tube along x with joints every 0.2 m, weights linear between neighbours.
RiggedMesh chain(int joints) {
  CylinderOptions options = cylinder_options();
  options.half_length = 0.1 * joints;
  options.rings_per_half = 10 * joints;
  RiggedMesh rig = two_bone_cylinder(options);
  rig.skeleton.joints.clear();
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < joints; ++j) {
    Joint joint;
    joint.name = "joint " + std::to_string(j);
    joint.parent = j - 1;
    joint.head = {0.2 * j - options.half_length, 0, 0};
    rig.skeleton.joints.push_back(joint);
  }
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const double s = std::clamp((rig.mesh.V(v, 0) + options.half_length) / 0.2 - 0.5, 0.0,
                                static_cast<double>(joints - 1));
    const int j = std::min(static_cast<int>(s), joints - 2);
    entries.emplace_back(v, j, 1 - (s - j));
    entries.emplace_back(v, j + 1, s - j);
  }
  rig.weights.resize(rig.mesh.vertex_count(), joints);
  rig.weights.setFromTriplets(entries.begin(), entries.end());
  return rig;
}

TEST(DualQuaternionBlend, RestPoseReturnsTheInput) {
  EXPECT_LE(fixtures::rest_pose_error<DualQuaternionBlend>(), 1e-15);
}

// The blend of the identity and a turn by theta at equal weights is a turn by theta/2.
TEST(DualQuaternionBlend, MidRingKeepsItsRadiusUnderTwistAndBend) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const double r = cylinder_options().radius;
  for (const char* axis : {"twist", "flexion"}) {
    const Eigen::Vector3d about = rig.skeleton.joints[1].axes.at(axis);
    for (const double degrees : {10.0, 60.0, 90.0, 135.0, 175.0}) {
      const Eigen::MatrixX3d posed = fixtures::deformed<DualQuaternionBlend>(
          rig, fixtures::turned(rig, "upper", axis, degrees * kDegree));
      const Eigen::Matrix3d half = Eigen::AngleAxisd(degrees * kDegree / 2, about).matrix();
      for (const int v : mid_ring(cylinder_options())) {
        const Eigen::Vector3d expected = half * Eigen::Vector3d(rig.mesh.V.row(v));
        EXPECT_NEAR(posed.row(v).norm(), r, 1e-6 * r) << axis << degrees;
        EXPECT_LE((posed.row(v).transpose() - expected).norm(), 1e-6 * r) << axis << degrees;
      }
    }
  }
}

// Each joint turns 30 degrees about x beyond its parent: nine of them pass 180 and reach 270
// degrees, where the quaternion of the last is the opposite half of the sphere from the first's.
// Neighbours differ by 30 degrees only, so every ring keeps its radius and turns steadily.
TEST(DualQuaternionBlend, ChainOf270DegreesTurnsSteadily) {
  const RiggedMesh rig = chain(10);
  std::vector<JointRotation> rotations;
  for (int j = 1; j < 10; ++j) {
    rotations.push_back(
        {j, Eigen::Quaterniond(Eigen::AngleAxisd(30 * kDegree, Eigen::Vector3d::UnitX()))});
  }
  const Pose pose = pose_from_rotations(rig.skeleton, rotations);
  const Eigen::MatrixX3d posed = fixtures::deformed<DualQuaternionBlend>(rig, pose);
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    double turn = 0;
    for (SkinWeights::InnerIterator it(rig.weights, v); it; ++it)
      turn += it.value() * 30 * static_cast<double>(it.col());
    const Eigen::Vector3d expected = Eigen::AngleAxisd(turn * kDegree, Eigen::Vector3d::UnitX()) *
                                     Eigen::Vector3d(rig.mesh.V.row(v));
    // Normalised linear interpolation over 30 degrees is off the constant speed by at most
    // 0.04 degrees: 7e-5 m at a radius of 0.1 m.
    EXPECT_LE((posed.row(v).transpose() - expected).norm(), 1e-4) << v;
  }
}

// The sign of a quaternion that a matrix gives is arbitrary: a whole turn of the figure carries
// every joint through both signs and must not change its shape.
TEST(DualQuaternionBlend, ShapeDoesNotDependOnTheSignsOfTheQuaternions) {
  const RiggedMesh rig = chain(6);
  std::vector<JointRotation> rotations;
  for (int j = 1; j < 6; ++j) {
    rotations.push_back({j, Eigen::Quaterniond(Eigen::AngleAxisd(
                                50 * kDegree, Eigen::Vector3d(0.2, 1, 0.3).normalized()))});
  }
  const Pose pose = pose_from_rotations(rig.skeleton, rotations);
  const Eigen::MatrixX3d still = fixtures::deformed<DualQuaternionBlend>(rig, pose);
  for (int step = 1; step < 24; ++step) {
    const Eigen::AngleAxisd turn(15 * kDegree * step, Eigen::Vector3d(1, 2, -1).normalized());
    Pose turned = pose;
    for (Eigen::Affine3d& transform : turned) transform = turn * transform;
    const Eigen::MatrixX3d posed = fixtures::deformed<DualQuaternionBlend>(rig, turned);
    const Eigen::MatrixX3d expected = still * turn.toRotationMatrix().transpose();
    EXPECT_LE(fixtures::largest_distance(posed, expected), 1e-13) << step;
  }
}

// Two joints of one vertex 200 degrees apart: the shorter way is the one of -160 degrees.
TEST(DualQuaternionBlend, BeyondAHalfTurnTheShorterWayIsTaken) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const Eigen::MatrixX3d beyond = fixtures::deformed<DualQuaternionBlend>(
      rig, fixtures::turned(rig, "upper", "twist", 200 * kDegree));
  const Eigen::MatrixX3d back = fixtures::deformed<DualQuaternionBlend>(
      rig, fixtures::turned(rig, "upper", "twist", -160 * kDegree));
  EXPECT_LE(fixtures::largest_distance(beyond, back), 1e-14);
}

// Joints that turn by up to 173 degrees about different axes: any number of influences, and with
// five copies two joints whose quaternions have a negative product, so that a sign matters.
TEST(DualQuaternionBlend, LanesAgreeWithTheFormula) {
  for (int copies = 1; copies <= 5; ++copies) {
    const RiggedMesh rig = fixtures::cylinder_of_many_influences(copies);
    Pose pose = fixtures::turned(rig, "upper", "flexion", 1.1);
    for (std::size_t j = 2; j < pose.size(); ++j) {
      const Eigen::Vector3d axis(1, 0.2 * static_cast<double>(j), -0.3);
      pose[j] = Eigen::AngleAxisd(0.4 * static_cast<double>(j), axis.normalized()) * pose[1];
    }
    // Weights are packed as floats: 6e-8 of the distances, which are below 2 m.
    EXPECT_LE(fixtures::largest_distance(fixtures::deformed<DualQuaternionBlend>(rig, pose),
                                         dual_quaternion_blend(rig, pose)),
              2e-7)
        << copies;
  }
}

TEST(DualQuaternionBlend, CopiesOfAJointActAsOne) {
  const RiggedMesh two = two_bone_cylinder(cylinder_options());
  const RiggedMesh many = fixtures::cylinder_of_many_influences(7);
  const Pose pose = fixtures::turned(two, "upper", "flexion", 1.4);
  Pose copied(many.skeleton.size(), pose[1]);
  copied[0] = pose[0];
  // Weights are packed as floats.
  EXPECT_LE(fixtures::largest_distance(fixtures::deformed<DualQuaternionBlend>(two, pose),
                                       fixtures::deformed<DualQuaternionBlend>(many, copied)),
            1e-7);
}

TEST(DualQuaternionBlend, ScaleAndShearAreDroppedAboutTheJointsHead) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const Pose rigid = fixtures::turned(rig, "upper", "flexion", 0.9);
  Pose scaled = rigid;
  const Eigen::Vector3d root = rig.skeleton.joints[0].head;
  scaled[0] = Eigen::Translation3d(root) * Eigen::Scaling(1.5, 0.7, 1.1) *
              Eigen::Translation3d(-root) * scaled[0];
  scaled[1] = scaled[1] * Eigen::Scaling(2.0);
  EXPECT_LE(fixtures::largest_distance(fixtures::deformed<DualQuaternionBlend>(rig, rigid),
                                       fixtures::deformed<DualQuaternionBlend>(rig, scaled)),
            1e-13);
}

TEST(DualQuaternionBlend, SameBitsForOneAndTwoThreads) {
  CylinderOptions options;
  options.segments = 96;
  const RiggedMesh rig = two_bone_cylinder(options);
  const DualQuaternionBlend method(rig);
  const Pose pose = fixtures::turned(rig, "upper", "flexion", 1.3);
  Eigen::MatrixX3d one, two;
  with_threads(1, [&] { method.deform(pose, one); });
  with_threads(2, [&] { method.deform(pose, two); });
  EXPECT_TRUE((one.array() == two.array()).all());
}

TEST(DualQuaternionBlend, RefusesAPoseThatDoesNotFit) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const DualQuaternionBlend method(rig);
  Eigen::MatrixX3d posed;
  EXPECT_THROW(method.deform(rest_pose(1), posed), Error);
  Pose pose = rest_pose(2);
  pose[1].translation().x() = std::nan("");
  EXPECT_THROW(method.deform(pose, posed), Error);
  EXPECT_THROW(dual_quaternion_blend(rig, rest_pose(1)), Error);
  EXPECT_THROW(dual_quaternion_blend(rig, pose), Error);
}

}  // namespace
}  // namespace geoprior::skinning
