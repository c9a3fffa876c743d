#include "baselines/skinning/linear_blend/linear_blend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/angles.h"
#include "core/error.h"
#include "core/parallel.h"
#include "tests/skinning/fixtures.h"

namespace geoprior::skinning {
namespace {

using fixtures::cylinder_options;

TEST(LinearBlend, RestPoseReturnsTheInput) {
  // Weights sum to 1 in double, so only rounding is left: far below 1e-6.
  EXPECT_LE(fixtures::rest_pose_error<LinearBlend>(), 1e-15);
}

// v' = (R + I)/2 v at weights 1/2, 1/2: a rotation by theta and the identity average to a scaling
// by cos(theta/2) in the plane of rotation (and a turn by theta/2).
TEST(LinearBlend, TwistShrinksMidRingToRCosHalfTheta) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  for (const double degrees : {10.0, 45.0, 90.0, 135.0, 170.0}) {
    const Eigen::MatrixX3d posed = fixtures::deformed<LinearBlend>(
        rig, fixtures::turned(rig, "upper", "twist", degrees * kDegree));
    const double expected = cylinder_options().radius * std::cos(degrees * kDegree / 2);
    for (const int v : mid_ring(cylinder_options())) {
      EXPECT_NEAR(std::hypot(posed(v, 1), posed(v, 2)), expected, 1e-6 * expected) << degrees;
      EXPECT_NEAR(posed(v, 0), 0, 1e-12);
    }
  }
}

TEST(LinearBlend, HalfTurnOfTwistCollapsesMidRingToAPoint) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const Eigen::MatrixX3d posed = fixtures::deformed<LinearBlend>(
      rig, fixtures::turned(rig, "upper", "twist", std::numbers::pi));
  for (const int v : mid_ring(cylinder_options())) EXPECT_LE(posed.row(v).norm(), 1e-15);
}

// The bend turns about +y, in the xz plane: the mid-ring keeps y and shrinks across it.
TEST(LinearBlend, BendCollapsesMidRingToRCosHalfTheta) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const double r = cylinder_options().radius;
  for (const double degrees : {10.0, 60.0, 90.0, 120.0, 160.0}) {
    const Eigen::MatrixX3d posed = fixtures::deformed<LinearBlend>(
        rig, fixtures::turned(rig, "upper", "flexion", degrees * kDegree));
    for (const int v : mid_ring(cylinder_options())) {
      const double in_plane = std::hypot(posed(v, 0), posed(v, 2));
      const double expected = std::abs(rig.mesh.V(v, 2)) * std::cos(degrees * kDegree / 2);
      EXPECT_NEAR(in_plane, expected, 1e-6 * r) << degrees;
      EXPECT_NEAR(posed(v, 1), rig.mesh.V(v, 1), 1e-6 * r) << degrees;
    }
  }
}

TEST(LinearBlend, LanesAgreeWithTheFormulaForAnyTransforms) {
  const RiggedMesh rig = fixtures::cylinder_of_many_influences(9);
  Pose pose = fixtures::turned(rig, "upper", "flexion", 1.1);
  RandomStream random(5, "affine");
  for (std::size_t j = 2; j < pose.size(); ++j) {
    for (int i = 0; i < 12; ++i) pose[j].matrix()(i / 4, i % 4) = random.normal();
  }
  // Weights are packed as floats: half a unit in the last place each, 11 of them.
  EXPECT_LE(fixtures::largest_distance(fixtures::deformed<LinearBlend>(rig, pose),
                                       linear_blend(rig, pose)),
            1e-6);
}

// The kernel is compiled apart for one to four influences and once for more.
TEST(LinearBlend, LanesAgreeWithTheFormulaForAnyNumberOfInfluences) {
  for (int copies = 1; copies <= 5; ++copies) {
    const RiggedMesh rig = fixtures::cylinder_of_many_influences(copies);
    Pose pose = fixtures::turned(rig, "upper", "flexion", 1.1);
    for (std::size_t j = 2; j < pose.size(); ++j)
      pose[j] = Eigen::AngleAxisd(0.3 * static_cast<double>(j), Eigen::Vector3d::UnitX()) * pose[1];
    EXPECT_LE(fixtures::largest_distance(fixtures::deformed<LinearBlend>(rig, pose),
                                         linear_blend(rig, pose)),
              1e-7)
        << copies;
  }
}

TEST(LinearBlend, SameBitsForOneAndTwoThreads) {
  CylinderOptions options;
  options.segments = 96;
  const RiggedMesh rig = two_bone_cylinder(options);
  const LinearBlend method(rig);
  const Pose pose = fixtures::turned(rig, "upper", "flexion", 1.3);
  Eigen::MatrixX3d one, two;
  with_threads(1, [&] { method.deform(pose, one); });
  with_threads(2, [&] { method.deform(pose, two); });
  EXPECT_TRUE((one.array() == two.array()).all());
}

// Large meshes are written past the caches, on another path.
TEST(LinearBlend, LargeMeshesTakeTheStreamedPathAndAgree) {
  CylinderOptions options;
  options.segments = 700;
  options.rings_per_half = 360;
  const RiggedMesh rig = two_bone_cylinder(options);
  ASSERT_GT(rig.mesh.vertex_count(), 500000);
  const Pose pose = fixtures::turned(rig, "upper", "twist", 0.8);
  EXPECT_LE(fixtures::largest_distance(fixtures::deformed<LinearBlend>(rig, pose),
                                       linear_blend(rig, pose)),
            1e-7);
}

TEST(LinearBlend, RefusesWrongInput) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  Eigen::MatrixX3d posed;
  EXPECT_THROW(LinearBlend(rig).deform(rest_pose(3), posed), Error);
  EXPECT_THROW(linear_blend(rig, rest_pose(3)), Error);
  RiggedMesh nan = rig;
  nan.mesh.V(5, 1) = std::nan("");
  EXPECT_THROW(LinearBlend{nan}, Error);
  rig.weights *= 0.5;
  EXPECT_THROW(LinearBlend{rig}, Error);
}

}  // namespace
}  // namespace geoprior::skinning
