#include "solvers/skinning/implicit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "baselines/skinning/dual_quaternion.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/procedural.h"
#include "metrics/joint_region.h"
#include "metrics/overlap_volume.h"

namespace geoprior::skinning {
namespace {

Pose bend(const RiggedMesh& rig, const std::string& joint, double degrees) {
  const int j = rig.skeleton.index_of(joint);
  const auto& axes = rig.skeleton.joints[j].axes;
  const Eigen::AngleAxisd turn(degrees * std::numbers::pi / 180, axes.at("flexion"));
  return pose_from_rotations(rig.skeleton, {{j, Eigen::Quaterniond(turn)}});
}

const RiggedMesh& finger() {
  static const RiggedMesh rig = capsule_finger();
  return rig;
}

ImplicitSkinning make(const RiggedMesh& rig, const ImplicitOptions& options = {}) {
  RunContext context;
  return {rig, options, context};
}

class RestPose : public testing::TestWithParam<int> {};

// Acceptance figure: 1e-6 of the bounding box's diagonal, cached and exact.
TEST_P(RestPose, ReturnsTheInput) {
  ImplicitOptions options;
  options.grid = GetParam();
  ImplicitSkinning skin = make(finger(), options);
  Eigen::MatrixX3d posed;
  RunContext context;
  skin.deform(rest_pose(finger().skeleton.size()), posed, context);
  EXPECT_LE((posed - finger().mesh.V).rowwise().norm().maxCoeff(),
            1e-6 * bounding_box_diagonal(finger().mesh.V));
}
INSTANTIATE_TEST_SUITE_P(Grids, RestPose, testing::Values(0, 16, 32));

TEST(ImplicitSkinning, RigidMotionOfTheWholeMovesTheInputRigidly) {
  ImplicitSkinning skin = make(finger());
  const Eigen::Isometry3d motion = Eigen::Translation3d(0.02, -0.05, 0.01) *
                                   Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized());
  const Pose pose(static_cast<std::size_t>(finger().skeleton.size()), Eigen::Affine3d(motion));
  Eigen::MatrixX3d posed;
  RunContext context;
  skin.deform(pose, posed, context);
  const Eigen::MatrixX3d moved =
      (finger().mesh.V * motion.linear().transpose()).rowwise() + motion.translation().transpose();
  // Fields are sampled in single precision: errors stay below the solve's tolerance, so no vertex
  // moves.
  EXPECT_LE((posed - moved).rowwise().norm().maxCoeff(),
            1e-6 * bounding_box_diagonal(finger().mesh.V));
}

TEST(ImplicitSkinning, FreeVerticesReachTheirIsoValue) {
  ImplicitOptions options;
  ImplicitSkinning skin = make(finger(), options);
  Eigen::MatrixX3d posed;
  RunContext context;
  skin.deform(bend(finger(), "middle", 60), posed, context);
  const auto d = skin.diagnostics();
  EXPECT_LE(d.at("field_error_max"), 1.01 * options.tolerance);
  EXPECT_EQ(d.at("unfinished_fraction"), 0);
}

double overlap(const RiggedMesh& rig, const JointRegion& region, const Eigen::MatrixX3d& posed,
               const Pose& pose) {
  return overlap_volume(posed, rig.mesh.F, joint_box(region, pose), region_column_spacing(region),
                        0)
      .volume;
}

TEST(ImplicitSkinning, LeavesAFifthOfTheSelfContactOfDualQuaternions) {
  const RiggedMesh& rig = finger();
  const int joint = rig.skeleton.index_of("middle");
  const JointRegion region = make_joint_region(rig, "middle", {joint}, {Eigen::Vector3d::UnitY()});
  ImplicitSkinning skin = make(rig);
  const DualQuaternionBlend dual_quaternions(rig);
  Eigen::MatrixX3d implicit, blended;
  RunContext context;
  for (const double angle : {80.0, 100.0, 120.0}) {
    const Pose pose = bend(rig, "middle", angle);
    skin.deform(pose, implicit, context);
    dual_quaternions.deform(pose, blended);
    const double before = overlap(rig, region, blended, pose);
    EXPECT_GT(before, 0) << angle;
    EXPECT_LE(overlap(rig, region, implicit, pose), 0.2 * before) << angle;
  }
}

TEST(ImplicitSkinning, GivesTheSameBitsForAnyNumberOfThreads) {
  ImplicitSkinning skin = make(finger());
  const Pose pose = bend(finger(), "middle", 110);
  Eigen::MatrixX3d one, two;
  RunContext context;
  with_threads(1, [&] { skin.deform(pose, one, context); });
  with_threads(2, [&] { skin.deform(pose, two, context); });
  EXPECT_TRUE((one.array() == two.array()).all());
}

TEST(ImplicitSkinning, HasNoMemoryOfEarlierPoses) {
  ImplicitSkinning fresh = make(finger()), used = make(finger());
  Eigen::MatrixX3d a, b;
  RunContext context;
  used.deform(bend(finger(), "proximal", 95), b, context);
  used.deform(bend(finger(), "middle", 70), b, context);
  fresh.deform(bend(finger(), "middle", 70), a, context);
  EXPECT_TRUE((a.array() == b.array()).all());
}

TEST(ImplicitSkinning, TheReleasedScheduleReachesTheIsoValues) {
  ImplicitOptions options;
  options.schedule = Schedule::released_code;
  ImplicitSkinning skin = make(finger(), options);
  Eigen::MatrixX3d posed;
  RunContext context;
  const Pose pose = bend(finger(), "middle", 90);
  skin.deform(pose, posed, context);
  EXPECT_TRUE(posed.allFinite());
  EXPECT_LE(skin.diagnostics().at("field_error_rms"), 2 * options.tolerance);
}

TEST(ImplicitSkinning, EveryOperatorSolvesABentFinger) {
  for (const BlendKind kind :
       {BlendKind::union_max, BlendKind::ricci, BlendKind::bulge_in_contact, BlendKind::contact}) {
    ImplicitOptions options;
    options.blend = kind;
    ImplicitSkinning skin = make(finger(), options);
    Eigen::MatrixX3d posed;
    RunContext context;
    skin.deform(bend(finger(), "middle", 60), posed, context);
    ASSERT_TRUE(posed.allFinite());
    skin.deform(rest_pose(finger().skeleton.size()), posed, context);
    EXPECT_LE((posed - finger().mesh.V).norm(), 1e-6) << static_cast<int>(kind);
  }
}

TEST(ImplicitSkinning, DropsScaleAndShearOfThePose) {
  ImplicitSkinning skin = make(finger());
  Pose plain = bend(finger(), "middle", 40), scaled = plain;
  const auto j = static_cast<std::size_t>(finger().skeleton.index_of("distal"));
  const Eigen::Vector3d head = finger().skeleton.joints[j].head;
  scaled[j] =
      scaled[j] * Eigen::Translation3d(head) * Eigen::Scaling(1.3) * Eigen::Translation3d(-head);
  Eigen::MatrixX3d a, b;
  RunContext context;
  skin.deform(plain, a, context);
  skin.deform(scaled, b, context);
  // The polar decomposition's round-off times the length of the finger.
  EXPECT_LE((a - b).rowwise().norm().maxCoeff(), 1e-6);
}

TEST(ImplicitSkinning, SamplesLieOnTheSkinOrOnTheBones) {
  const ImplicitSkinning skin = make(finger());
  const ImplicitSkinning::Samples samples = skin.samples();
  ASSERT_GT(samples.points.rows(), 4 * 45);
  for (Eigen::Index i = 0; i < samples.points.rows(); ++i) {
    EXPECT_NEAR(samples.normals.row(i).norm(), 1, 1e-9);
    const double to_axis = samples.points.row(i).tail<2>().norm();  // the finger is along x
    if (samples.is_cap[i]) {
      EXPECT_LE(to_axis, 1e-9);
    } else if (samples.points(i, 0) > 0.02 && samples.points(i, 0) < 0.08) {
      EXPECT_GT(to_axis, 0.006);
    }
  }
}

Eigen::MatrixX3d bent_finger(const ImplicitOptions& options) {
  ImplicitSkinning skin = make(finger(), options);
  Eigen::MatrixX3d posed;
  RunContext context;
  skin.deform(bend(finger(), "middle", 60), posed, context);
  return posed;
}

TEST(ImplicitSkinning, AJointKeepsWhatItsOwnBlendLeavesOut) {
  ImplicitOptions options;
  options.blend = BlendKind::bulge_in_contact;
  options.opening = OpeningPreset::bulge;
  const Eigen::MatrixX3d all = bent_finger(options);
  options.joint_blends = {{"middle", std::nullopt, OpeningPreset::bulge}};
  EXPECT_TRUE((bent_finger(options).array() == all.array()).all());
  options.joint_blends = {{"middle", BlendKind::bulge_in_contact, std::nullopt}};
  EXPECT_TRUE((bent_finger(options).array() == all.array()).all());
  // What they name does count.
  options.joint_blends = {{"middle", BlendKind::union_max, std::nullopt}};
  EXPECT_GT((bent_finger(options) - all).rowwise().norm().maxCoeff(), 1e-5);
}

TEST(ImplicitSkinning, RefusesOpenMeshesAndUnknownJoints) {
  RiggedMesh open = finger();
  open.mesh.F.conservativeResize(open.mesh.F.rows() - 1, 3);
  EXPECT_THROW(make(open), Error);
  ImplicitOptions options;
  options.joint_blends.push_back({"no such joint", BlendKind::ricci, OpeningPreset::elbow});
  EXPECT_THROW(make(finger(), options), Error);
  ImplicitSkinning skin = make(finger());
  Eigen::MatrixX3d posed;
  RunContext context;
  EXPECT_THROW(skin.deform(rest_pose(2), posed, context), Error);
}

TEST(ImplicitSkinning, AcceptsFlatRigsAndJointsWithoutSkin) {
  RiggedMesh rig = finger();
  for (Joint& joint : rig.skeleton.joints) joint.parent = -1;
  for (Joint& joint : rig.skeleton.joints) joint.tail.reset();
  Joint tip;
  tip.name = "tip";
  tip.head = Eigen::Vector3d(0.09, 0, 0);
  rig.skeleton.joints.push_back(tip);
  SkinWeights weights(rig.weights.rows(), rig.weights.cols() + 1);
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < rig.weights.rows(); ++v) {
    for (SkinWeights::InnerIterator it(rig.weights, v); it; ++it) {
      entries.emplace_back(v, static_cast<int>(it.col()), it.value());
    }
  }
  weights.setFromTriplets(entries.begin(), entries.end());
  rig.weights = weights;
  ImplicitSkinning skin = make(rig);
  Eigen::MatrixX3d posed;
  RunContext context;
  skin.deform(rest_pose(rig.skeleton.size()), posed, context);
  EXPECT_LE((posed - rig.mesh.V).norm(), 1e-6);
}

}  // namespace
}  // namespace geoprior::skinning
