#include "experiments/skinning/weights/heat_weights.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/skinning/fixtures.h"

namespace geoprior::skinning {
namespace {

using fixtures::cylinder_options;

double weight_sum(const SkinWeights& weights, int v) { return weights.row(v).sum(); }

TEST(HeatWeights, ArePartitionsOfUnityWithAtMostTheAskedInfluences) {
  const RiggedMesh finger = capsule_finger();
  for (const int influences : {0, 1, 2, 4}) {
    const SkinWeights weights =
        heat_weights(finger.mesh, finger.skeleton, {.max_influences = influences});
    validate(weights, finger.mesh.vertex_count(), finger.skeleton.size());
    for (int v = 0; v < finger.mesh.vertex_count(); ++v) {
      EXPECT_NEAR(weight_sum(weights, v), 1, 1e-14);
      const auto kept = weights.row(v).nonZeros();
      EXPECT_LE(kept, influences > 0 ? influences : 4);
    }
  }
}

// The two halves of the cylinder are mirror images: w_upper(x) = w_lower(-x).
TEST(HeatWeights, MirrorTheSymmetryOfTheCylinder) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const SkinWeights weights = heat_weights(rig.mesh, rig.skeleton);
  for (const int v : mid_ring(cylinder_options())) {
    EXPECT_NEAR(weights.coeff(v, 0), 0.5, 1e-9);
    EXPECT_NEAR(weights.coeff(v, 1), 0.5, 1e-9);
  }
  const int rings = (rig.mesh.vertex_count() - 2) / cylinder_options().segments;
  for (int i = 0; i < rings; ++i) {
    const int v = 1 + i * cylinder_options().segments;
    const int mirrored = 1 + (rings - 1 - i) * cylinder_options().segments;
    EXPECT_NEAR(weights.coeff(v, 0), weights.coeff(mirrored, 1), 1e-9) << i;
  }
}

TEST(HeatWeights, RiseAlongTheBone) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const SkinWeights weights = heat_weights(rig.mesh, rig.skeleton, {.smallest_weight = 0});
  const int segments = cylinder_options().segments;
  double last = 0;
  for (int v = 1; v + segments < rig.mesh.vertex_count(); v += segments) {
    EXPECT_GE(weights.coeff(v, 1), last - 1e-12) << v;
    last = weights.coeff(v, 1);
  }
  EXPECT_GT(last, 1 - std::exp(-5.0));  // half_length / radius = 5, see the closed form below
}

// Far from its ends a cylinder's heat equation is one-dimensional: -w'' + (c / r^2) w = (c / r^2) p
// with p the step function, whose solution is exp(-sqrt(c) x / r) / 2 on the far side.
TEST(HeatWeights, DecayAsTheClosedFormOnACylinder) {
  CylinderOptions options;
  options.segments = 96;
  options.rings_per_half = 120;
  options.radius = 0.05;
  const RiggedMesh rig = two_bone_cylinder(options);
  for (const double heat : {1.0, 0.25}) {
    const SkinWeights weights = heat_weights(
        rig.mesh, rig.skeleton, {.heat = heat, .max_influences = 0, .smallest_weight = 0});
    double worst = 0;
    for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
      const double x = rig.mesh.V(v, 0);
      if (x < 0 || x > 0.2) continue;
      const double expected = 0.5 * std::exp(-std::sqrt(heat) * x / options.radius);
      worst = std::max(worst, std::abs(weights.coeff(v, 0) - expected));
    }
    // Piecewise linear elements of h = r / 12: second order, (h / r)^2 / 12 = 6e-4.
    EXPECT_LE(worst, 1e-3) << heat;
  }
}

// A bone outside the mesh is seen by no vertex; a joint without tail has no bone.
TEST(HeatWeights, BonesThatNobodySeesGetNothing) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  Joint outside;
  outside.name = "outside";
  outside.parent = 0;
  outside.head = {0, 0.11, 0};  // 0.01 m above the skin, nearer than the bones inside
  outside.tail = Eigen::Vector3d(0.3, 0.11, 0);
  rig.skeleton.joints.push_back(outside);
  Joint point;
  point.name = "point";
  point.parent = 0;
  rig.skeleton.joints.push_back(point);
  const SkinWeights weights = heat_weights(rig.mesh, rig.skeleton);
  EXPECT_EQ(Eigen::VectorXd(weights.col(2)).sum(), 0);
  EXPECT_EQ(Eigen::VectorXd(weights.col(3)).sum(), 0);
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) EXPECT_NEAR(weight_sum(weights, v), 1, 1e-14);
}

// A second component away from all bones (an eye, a button) takes the nearest one.
TEST(HeatWeights, ComponentsWithoutABoneTakeTheNearest) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  CylinderOptions small = cylinder_options();
  small.radius = 0.01;
  small.half_length = 0.02;
  const TriMesh button = two_bone_cylinder(small).mesh;
  const int n = rig.mesh.vertex_count();
  TriMesh both;
  both.V.resize(n + button.vertex_count(), 3);
  both.V << rig.mesh.V, button.V.rowwise() + Eigen::RowVector3d(0.4, 0.2, 0);
  both.F.resize(rig.mesh.triangle_count() + button.triangle_count(), 3);
  both.F << rig.mesh.F, (button.F.array() + n).matrix();
  const SkinWeights weights = heat_weights(both, rig.skeleton);
  for (int v = n; v < both.vertex_count(); ++v) EXPECT_NEAR(weights.coeff(v, 1), 1, 1e-6) << v;
}

TEST(HeatWeights, RefusesWrongInput) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  EXPECT_THROW(heat_weights(rig.mesh, rig.skeleton, {.heat = 0}), Error);
  EXPECT_THROW(heat_weights(rig.mesh, rig.skeleton, {.max_influences = -1}), Error);
  for (Joint& joint : rig.skeleton.joints) joint.tail.reset();
  EXPECT_THROW(heat_weights(rig.mesh, rig.skeleton), Error);
}

}  // namespace
}  // namespace geoprior::skinning
