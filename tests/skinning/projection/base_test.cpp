#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/geometry/procedural.h"
#include "metrics/volume/overlap_volume.h"
#include "solvers/skinning/base/base_skin.h"
#include "solvers/skinning/base/spread_weights.h"
#include "solvers/skinning/implicit.h"
#include "solvers/skinning/smooth/limbs.h"
#include "tests/skinning/fixtures.h"

namespace geoprior::skinning {
namespace {

constexpr double kTubeSize = 0.05;

/// A tube about the x axis, whose weights change from one bone to the other within 2 cm.
RiggedMesh narrow_tube(int segments, int rings_per_half) {
  CylinderOptions options = fixtures::fine_cylinder_options(segments, rings_per_half);
  options.ramp_width = 0.02;
  return two_bone_cylinder(options);
}

double upper_weight(const RiggedMesh& rig, const SkinWeights& weights, double x) {
  double nearest = 1, weight = -1;
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const double distance = std::abs(rig.mesh.V(v, 0) - x);
    if (distance >= nearest) continue;
    nearest = distance;
    weight = weights.coeff(v, rig.skeleton.index_of("upper"));
  }
  return weight;
}

SkinWeights spread(const RiggedMesh& rig) {
  return spread_weights(rig, Eigen::VectorXd::Constant(rig.mesh.vertex_count(), kTubeSize), 0.6);
}

TEST(SpreadWeights, SumToOneAndGrowAlongTheLimb) {
  const RiggedMesh rig = narrow_tube(24, 40);
  const SkinWeights wide = spread(rig);
  EXPECT_NO_THROW(validate(wide, rig.mesh.vertex_count(), rig.skeleton.size()));
  EXPECT_NEAR(upper_weight(rig, wide, 0), 0.5, 0.02);
  double before = 0;
  for (double x = -0.1; x < 0.11; x += 0.02) {
    const double weight = upper_weight(rig, wide, x);
    EXPECT_GE(weight, before - 1e-9) << x;
    before = weight;
  }
  // Variance of the kernel: 2 width^2, one standard deviation from the joint.
  const double deviation = std::sqrt(2.0) * 0.6 * kTubeSize;
  EXPECT_GT(upper_weight(rig, wide, deviation), 0.75);
  EXPECT_LT(upper_weight(rig, wide, deviation), 0.95);
}

// The width is one of the limb, not of the mesh.
TEST(SpreadWeights, AreThoseOfAFinerMesh) {
  const RiggedMesh coarse = narrow_tube(24, 40), fine = narrow_tube(48, 80);
  const SkinWeights one = spread(coarse), other = spread(fine);
  for (const double x : {-0.08, -0.04, 0.0, 0.04, 0.08})
    EXPECT_NEAR(upper_weight(coarse, one, x), upper_weight(fine, other, x), 0.02) << x;
}

/// Of a tube whose bones are `slimness` times its radius long, at its joint, in radii.
double spread_length(double slimness) {
  CylinderOptions options = fixtures::fine_cylinder_options(24, 20);
  options.half_length = slimness * options.radius;
  options.cap_height = 0.2 * options.radius;
  const RiggedMesh rig = two_bone_cylinder(options);
  const BonePartition partition = partition_bones(rig, PartitionRule::highest_weight, 1);
  const Eigen::VectorXd length = spread_lengths(rig, partition, ShortLimbs::less);
  Eigen::Index middle = 0;
  rig.mesh.V.col(0).cwiseAbs().minCoeff(&middle);
  return length(middle) / options.radius;
}

// Joints of a phalanx are too near to each other for the width that a knee has.
TEST(SpreadLengths, AreTheRadiusButLessOnShortLimbs) {
  EXPECT_NEAR(spread_length(8), 1, 0.02);
  EXPECT_NEAR(spread_length(5), 1, 0.02);
  EXPECT_NEAR(spread_length(3), 0.2, 0.02);
  EXPECT_GT(spread_length(3.7), 0.3);
  EXPECT_LT(spread_length(3.7), 0.9);
  EXPECT_NEAR(spread_length(1.5), 1, 0.02);
}

TEST(BaseSkin, IsCentersOfRotationOnTheTrunkAndDualQuaternionsOnLimbs) {
  const RiggedMesh rig = capsule_finger();
  const Pose pose = fixtures::turned(rig, "middle", "flexion", 1.2);
  const int n = rig.mesh.vertex_count();
  const Eigen::MatrixX3d limb = fixtures::deformed<DualQuaternionBlend>(rig, pose);
  const Eigen::MatrixX3d trunk = fixtures::deformed<CentersOfRotation>(rig, pose);
  ASSERT_GT((limb - trunk).rowwise().norm().maxCoeff(), 1e-4);
  Eigen::MatrixX3d posed;
  for (const double share : {0.0, 0.25, 1.0}) {
    BaseSkin(rig, BaseKind::limbs_and_trunk, Eigen::VectorXd::Constant(n, share))
        .deform(pose, posed);
    EXPECT_LE((posed - trunk - share * (limb - trunk)).cwiseAbs().maxCoeff(), 1e-12) << share;
  }
}

double volume_change(const RiggedMesh& rig, const ImplicitOptions& options, double angle) {
  RunContext context;
  ImplicitSkinning skin(rig, options, context);
  Eigen::MatrixX3d posed;
  skin.deform(fixtures::turned(rig, "upper", "flexion", angle), posed, context);
  // Of the two diameters about the joint that bend.
  const double bent = std::numbers::pi * kTubeSize * kTubeSize * 4 * kTubeSize;
  return (signed_volume(posed, rig.mesh.F) - signed_volume(rig.mesh.V, rig.mesh.F)) / bent;
}

TEST(JointVolumes, GiveBackWhatABentTubeLoses) {
  const RiggedMesh rig = narrow_tube(24, 30);
  for (const BaseKind base :
       {BaseKind::dual_quaternion, BaseKind::centers_of_rotation, BaseKind::direct_delta_mush}) {
    ImplicitOptions options;
    options.base = base;
    EXPECT_NEAR(volume_change(rig, options, 1.2), 0, 0.003);
    // The null: what is not given back is more.
    options.smooth.volume = false;
    EXPECT_GT(std::abs(volume_change(rig, options, 1.2)), 0.003);
  }
}

// In contact there is less room: what is left is bounded, and less than without.
TEST(JointVolumes, GiveBackMostOfWhatContactTakes) {
  const RiggedMesh rig = narrow_tube(24, 30);
  ImplicitOptions options;
  const double with = std::abs(volume_change(rig, options, 2.2));
  options.smooth.volume = false;
  const double without = std::abs(volume_change(rig, options, 2.2));
  RecordProperty("with", std::to_string(with));
  RecordProperty("without", std::to_string(without));
  EXPECT_LE(with, 0.02);
  EXPECT_LE(with, 0.5 * without);
}

}  // namespace
}  // namespace geoprior::skinning
