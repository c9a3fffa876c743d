#include "solvers/skinning/implicit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <numbers>

#include "baselines/skinning/centers_of_rotation/centers_of_rotation.h"
#include "baselines/skinning/direct_delta_mush/direct_delta_mush.h"
#include "baselines/skinning/dual_quaternion/dual_quaternion.h"
#include "core/error.h"
#include "core/geometry/procedural.h"
#include "core/parallel.h"
#include "metrics/contact/joint_region.h"
#include "metrics/volume/overlap_volume.h"

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

constexpr double kFingerRadius = 0.009;  // at the joint "middle"

/// As published.
ImplicitOptions marching() {
  ImplicitOptions options;
  options.projection = ProjectionKind::marching;
  return options;
}

ImplicitSkinning make(const RiggedMesh& rig, const ImplicitOptions& options = marching()) {
  RunContext context;
  return {rig, options, context};
}

class RestPose : public testing::TestWithParam<int> {};

// Acceptance figure: 1e-6 of the bounding box's diagonal, cached and exact.
TEST_P(RestPose, ReturnsTheInput) {
  ImplicitOptions options = marching();
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
  const Pose pose(finger().skeleton.size(), Eigen::Affine3d(motion));
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

/// Distance of each vertex from the rigid motion of its own bone, where its bone is the only one
/// near: at least `margin` from the joint along the axis, on either side of it.
double largest_distance_from_bones(const RiggedMesh& rig, const std::string& joint,
                                   const Pose& pose, double margin, const Eigen::MatrixX3d& posed) {
  const int j = rig.skeleton.index_of(joint);
  const double x0 = rig.skeleton.joints[j].head.x();
  double most = 0;
  for (Eigen::Index v = 0; v < posed.rows(); ++v) {
    const Eigen::Vector3d rest = rig.mesh.V.row(v);
    if (std::abs(rest.x() - x0) < margin) continue;
    const Eigen::Vector3d rigid = rest.x() < x0 ? rest : Eigen::Vector3d(pose[j] * rest);
    most = std::max(most, (posed.row(v).transpose() - rigid).norm());
  }
  return most;
}

const RiggedMesh& tube() {
  static const RiggedMesh rig = two_bone_cylinder();
  return rig;
}
constexpr double kTubeRadius = 0.1;

/// By how much vertices of a bent tube pass the plane that halves the bend, in radii. The halves
/// are mirror images in it: where they touch, they touch there.
double largest_crossing(double degrees, const Eigen::MatrixX3d& posed) {
  const double angle = degrees * std::numbers::pi / 180;
  const Eigen::Vector3d upper(std::cos(angle), 0, -std::sin(angle)), lower(-1, 0, 0);
  const Eigen::Vector3d normal = (upper - lower).normalized();
  double most = 0;
  for (Eigen::Index v = 0; v < posed.rows(); ++v) {
    const double side = tube().mesh.V(v, 0);
    if (std::abs(side) < 1e-9) continue;
    most = std::max(most, (side < 0 ? 1 : -1) * posed.row(v).dot(normal));
  }
  return most / kTubeRadius;
}

// Symmetry and rigid motion say where vertices are: whatever the fields, those in contact lie on
// the plane that halves the bend, and those far from the joint on their bone.
TEST(ImplicitSkinning, HalvesOfABentTubeMeetOnThePlaneThatHalvesTheBend) {
  ImplicitSkinning skin = make(tube());
  const DualQuaternionBlend dual_quaternions(tube());
  Eigen::MatrixX3d posed, blended;
  RunContext context;
  for (const double angle : {100.0, 110.0}) {
    const Pose pose = bend(tube(), "upper", angle);
    skin.deform(pose, posed, context);
    dual_quaternions.deform(pose, blended);
    EXPECT_GT(largest_crossing(angle, blended), 0.1) << angle;
    EXPECT_LT(largest_crossing(angle, posed), 0.03) << angle;
    EXPECT_LT(largest_distance_from_bones(tube(), "upper", pose, 3 * kTubeRadius, posed),
              0.001 * kTubeRadius)
        << angle;
  }
}

// Free vertices stand where the composed field, sampled anew at their places, has their iso-value.
TEST(ImplicitSkinning, FieldAtThePosedSkinIsThatOfTheRestPoseBesidesContact) {
  ImplicitOptions options = marching();
  ImplicitSkinning skin = make(finger(), options);
  Eigen::MatrixX3d posed;
  RunContext context;
  skin.deform(bend(finger(), "middle", 30), posed, context);
  EXPECT_LE(skin.field_error(posed).cwiseAbs().maxCoeff(), 1.01 * options.tolerance);
  // Off the skin it is not: a hundredth of the finger's radius further out.
  const TriMesh surface{posed, finger().mesh.F};
  const Eigen::MatrixX3d out = posed + 0.01 * kFingerRadius * vertex_normals(surface);
  EXPECT_GT(skin.field_error(out).cwiseAbs().maxCoeff(), 2 * options.tolerance);
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
  ImplicitOptions options = marching();
  options.schedule = Schedule::released_code;
  ImplicitSkinning skin = make(finger(), options);
  Eigen::MatrixX3d posed;
  RunContext context;
  const Pose pose = bend(finger(), "middle", 90);
  skin.deform(pose, posed, context);
  ImplicitSkinning papers = make(finger());
  Eigen::MatrixX3d other;
  papers.deform(pose, other, context);
  // Two ways to one surface: a tenth of the radius at the joint.
  RecordProperty("apart",
                 std::to_string((posed - other).rowwise().norm().maxCoeff() / kFingerRadius));
  EXPECT_LE((posed - other).rowwise().norm().maxCoeff(), 0.1 * kFingerRadius);
}

TEST(ImplicitSkinning, EveryOperatorKeepsVolumeAndBonesOfABentFinger) {
  const RiggedMesh& rig = finger();
  const double rest_volume = signed_volume(rig.mesh.V, rig.mesh.F);
  for (const BlendKind kind :
       {BlendKind::union_max, BlendKind::ricci, BlendKind::gradient_controlled,
        BlendKind::bulge_in_contact, BlendKind::contact}) {
    ImplicitOptions options = marching();
    options.blend = kind;
    ImplicitSkinning skin = make(rig, options);
    Eigen::MatrixX3d posed;
    RunContext context;
    const Pose pose = bend(rig, "middle", 60);
    skin.deform(pose, posed, context);
    const std::string name = std::to_string(static_cast<int>(kind));
    RecordProperty("volume_" + name,
                   std::to_string(signed_volume(posed, rig.mesh.F) / rest_volume));
    RecordProperty(
        "bones_" + name,
        std::to_string(largest_distance_from_bones(rig, "middle", pose, 2 * kFingerRadius, posed) /
                       kFingerRadius));
    EXPECT_NEAR(signed_volume(posed, rig.mesh.F) / rest_volume, 1, 0.01) << name;
    EXPECT_LE(largest_distance_from_bones(rig, "middle", pose, 2 * kFingerRadius, posed),
              0.001 * kFingerRadius)
        << name;
    skin.deform(rest_pose(rig.skeleton.size()), posed, context);
    EXPECT_LE((posed - finger().mesh.V).norm(), 1e-6) << static_cast<int>(kind);
  }
}

TEST(ImplicitSkinning, DropsScaleAndShearOfThePose) {
  ImplicitSkinning skin = make(finger());
  Pose plain = bend(finger(), "middle", 40), scaled = plain;
  const std::size_t j = finger().skeleton.index_of("distal");
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
  ImplicitOptions options = marching();
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
  ImplicitOptions options = marching();
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

ImplicitOptions smooth_projection() {
  ImplicitOptions options;
  options.projection = ProjectionKind::smooth;
  return options;
}

/// The smooth correction of a skin that is moved by its weights as they are.
ImplicitOptions smooth_on(BaseKind base) {
  ImplicitOptions options = smooth_projection();
  options.base = base;
  options.smooth.spread = 0;
  options.smooth.volume = false;
  return options;
}

TEST(SmoothProjection, ReturnsTheRestPose) {
  ImplicitSkinning skin = make(finger(), smooth_projection());
  Eigen::MatrixX3d posed;
  RunContext context;
  skin.deform(rest_pose(finger().skeleton.size()), posed, context);
  EXPECT_LE((posed - finger().mesh.V).rowwise().norm().maxCoeff(),
            1e-6 * bounding_box_diagonal(finger().mesh.V));
}

TEST(SmoothProjection, LeavesAFifthOfTheSelfContactOfDualQuaternions) {
  const RiggedMesh& rig = finger();
  const int joint = rig.skeleton.index_of("middle");
  const JointRegion region = make_joint_region(rig, "middle", {joint}, {Eigen::Vector3d::UnitY()});
  ImplicitSkinning skin = make(rig, smooth_projection());
  const DualQuaternionBlend dual_quaternions(rig);
  Eigen::MatrixX3d smooth, blended;
  RunContext context;
  for (const double angle : {60.0, 80.0, 100.0, 120.0}) {
    const Pose pose = bend(rig, "middle", angle);
    skin.deform(pose, smooth, context);
    dual_quaternions.deform(pose, blended);
    const double before = overlap(rig, region, blended, pose);
    EXPECT_GT(before, 0) << angle;
    EXPECT_LE(overlap(rig, region, smooth, pose), (angle < 70 ? 1.0 : 0.2) * before) << angle;
  }
}

// Dual quaternions keep the section of a twisted tube: nothing is asked of it. The published
// projection, whose fields do not twist with the skin, has no reason to leave a tube that is not
// round alone.
TEST(SmoothProjection, LeavesATwistAlone) {
  RiggedMesh flat = tube();
  flat.mesh.V.col(1) *= 0.5;
  const DualQuaternionBlend dual_quaternions(flat);
  const Eigen::AngleAxisd turn(std::numbers::pi / 3, Eigen::Vector3d::UnitX());
  const Pose pose = pose_from_rotations(
      flat.skeleton, {{flat.skeleton.index_of("upper"), Eigen::Quaterniond(turn)}});
  Eigen::MatrixX3d smooth, marching, blended;
  RunContext context;
  dual_quaternions.deform(pose, blended);
  make(flat, smooth_on(BaseKind::dual_quaternion)).deform(pose, smooth, context);
  make(flat).deform(pose, marching, context);
  EXPECT_LE((smooth - blended).rowwise().norm().maxCoeff(), 0.02 * kTubeRadius);
  EXPECT_GE((marching - blended).rowwise().norm().maxCoeff(), 0.1 * kTubeRadius);
}

TEST(SmoothProjection, GivesTheSameBitsForAnyNumberOfThreadsAndNoMatterWhatCameBefore) {
  ImplicitSkinning skin = make(finger(), smooth_projection());
  const Pose pose = bend(finger(), "middle", 110);
  Eigen::MatrixX3d one, two;
  RunContext context;
  with_threads(1, [&] { skin.deform(pose, one, context); });
  skin.deform(bend(finger(), "proximal", 95), two, context);
  with_threads(2, [&] { skin.deform(pose, two, context); });
  EXPECT_TRUE((one.array() == two.array()).all());
}

ImplicitOptions tracking() {
  ImplicitOptions options;
  options.projection = ProjectionKind::tracking;
  return options;
}

/// Bends the finger's middle joint through angles, one pose after the other.
Eigen::MatrixX3d after(ImplicitSkinning& skin, const std::vector<double>& angles) {
  Eigen::MatrixX3d posed;
  RunContext context;
  for (const double angle : angles) skin.deform(bend(finger(), "middle", angle), posed, context);
  return posed;
}

// Acceptance figure: a loop returns within half a percent of the local radius.
TEST(Tracking, ComesBackWhereItWas) {
  ImplicitSkinning skin = make(finger(), tracking());
  const Eigen::MatrixX3d out = after(skin, {0, 40, 80});
  const Eigen::MatrixX3d back = after(skin, {120, 80});
  EXPECT_LE((out - back).rowwise().norm().maxCoeff(), 0.005 * kFingerRadius);
  const Eigen::MatrixX3d rest = after(skin, {40, 0});
  EXPECT_LE((rest - finger().mesh.V).rowwise().norm().maxCoeff(), 0.005 * kFingerRadius);
}

TEST(Tracking, TakesALongWayInSteps) {
  ImplicitSkinning one = make(finger(), tracking()), many = make(finger(), tracking());
  const Eigen::MatrixX3d jump = after(one, {0, 110});
  const Eigen::MatrixX3d walk = after(many, {0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110});
  EXPECT_LE((jump - walk).rowwise().norm().maxCoeff(), 1e-3 * kFingerRadius);
}

TEST(Tracking, ForgetsWhatWasBeforeARestart) {
  ImplicitSkinning fresh = make(finger(), tracking()), used = make(finger(), tracking());
  EXPECT_TRUE(fresh.path_dependent());
  after(used, {0, 115});
  used.restart();
  Eigen::MatrixX3d one, two;
  with_threads(1, [&] { one = after(fresh, {0, 50, 100}); });
  with_threads(2, [&] { two = after(used, {0, 50, 100}); });
  EXPECT_TRUE((one.array() == two.array()).all());
}

TEST(Tracking, WalksToAFirstPoseFromRest) {
  ImplicitSkinning begun = make(finger(), tracking()), walked = make(finger(), tracking());
  const Eigen::MatrixX3d one = after(begun, {110}), other = after(walked, {0, 110});
  EXPECT_LE((one - other).rowwise().norm().maxCoeff(), 1e-6 * kFingerRadius);
  begun.restart();
  EXPECT_EQ(after(begun, {110}), one);
}

TEST(Tracking, RefusesAPoseOfOtherJoints) {
  ImplicitSkinning skin = make(finger(), tracking());
  Eigen::MatrixX3d posed;
  RunContext context;
  EXPECT_THROW(skin.deform({}, posed, context), Error);
  Pose broken = rest_pose(finger().skeleton.size());
  broken.back().translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(skin.deform(broken, posed, context), Error);
}

TEST(Tracking, MayBeginAnywhereInSpace) {
  ImplicitSkinning skin = make(finger(), tracking());
  const Eigen::Isometry3d motion(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized()));
  const Pose pose(finger().skeleton.size(), Eigen::Affine3d(motion));
  Eigen::MatrixX3d posed;
  RunContext context;
  EXPECT_NO_THROW(skin.deform(pose, posed, context));
}

constexpr std::array<BaseKind, 3> kBases{BaseKind::dual_quaternion, BaseKind::centers_of_rotation,
                                         BaseKind::direct_delta_mush};

Eigen::MatrixX3d base_alone(BaseKind base, const Pose& pose) {
  Eigen::MatrixX3d posed;
  switch (base) {
    case BaseKind::dual_quaternion:
      DualQuaternionBlend(finger()).deform(pose, posed);
      break;
    case BaseKind::centers_of_rotation:
      CentersOfRotation(finger()).deform(pose, posed);
      break;
    case BaseKind::direct_delta_mush:
      DirectDeltaMush(finger()).deform(pose, posed);
      break;
    case BaseKind::limbs_and_trunk:
      break;
  }
  return posed;
}

TEST(Base, WithoutEvaluationsIsWhatStays) {
  const Pose pose = bend(finger(), "middle", 90);
  for (const ProjectionKind projection : {ProjectionKind::smooth, ProjectionKind::marching}) {
    for (const BaseKind base : kBases) {
      ImplicitOptions options = smooth_on(base);
      options.projection = projection;
      options.smooth.evaluations = options.smooth.contact_evaluations = 0;
      options.max_iterations = 0;
      Eigen::MatrixX3d posed;
      RunContext context;
      make(finger(), options).deform(pose, posed, context);
      EXPECT_LE((posed - base_alone(base, pose)).rowwise().norm().maxCoeff(), 1e-12);
    }
  }
}

// Whatever is corrected is at rest at rest, and moves where the bent finger touches itself.
TEST(Base, StaysAtRestAndIsCorrectedWhereItTouches) {
  for (const BaseKind base : kBases) {
    ImplicitSkinning skin = make(finger(), smooth_on(base));
    Eigen::MatrixX3d posed;
    RunContext context;
    skin.deform(rest_pose(finger().skeleton.size()), posed, context);
    EXPECT_LE((posed - finger().mesh.V).rowwise().norm().maxCoeff(), 1e-6 * kFingerRadius);
    const Pose bent = bend(finger(), "middle", 110);
    skin.deform(bent, posed, context);
    EXPECT_GE((posed - base_alone(base, bent)).rowwise().norm().maxCoeff(), 0.02 * kFingerRadius);
    EXPECT_GT(skin.diagnostics().at("stopped_fraction"), 0);
  }
}

// A null: without evaluations there is nothing to follow.
TEST(SmoothProjection, WithoutEvaluationsIsWhereItStarted) {
  ImplicitOptions options = smooth_on(BaseKind::dual_quaternion);
  options.smooth.evaluations = options.smooth.contact_evaluations = 0;
  Eigen::MatrixX3d posed, blended;
  RunContext context;
  const Pose pose = bend(finger(), "middle", 90);
  make(finger(), options).deform(pose, posed, context);
  DualQuaternionBlend(finger()).deform(pose, blended);
  EXPECT_LE((posed - blended).rowwise().norm().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace geoprior::skinning
