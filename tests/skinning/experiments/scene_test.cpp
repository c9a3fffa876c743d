#include "experiments/skinning/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::skinning {
namespace {

using testing::HasSubstr;

std::shared_ptr<SkinningScene> load(const SkinningSceneOptions& options) {
  return load_skinning_scene(options, ".");
}

std::string error_of(const SkinningSceneOptions& options) {
  return test::error_of([&] { load(options); });
}

SkinningSceneOptions cylinder(const std::string& joint = "upper") {
  SkinningSceneOptions options;
  options.character.character = "cylinder";
  options.character.cylinder.segments = 12;
  options.character.cylinder.rings_per_half = 8;
  options.motion.joint = joint;
  options.motion.frames = 4;
  return options;
}

/// The split mesh is the welded one with seams: same places, same triangles.
void expect_split_follows_weld(const SkinningScene& scene) {
  ASSERT_EQ(scene.welded_of_input.size(), static_cast<std::size_t>(scene.input_mesh.V.rows()));
  for (int v = 0; v < scene.input_mesh.vertex_count(); ++v) {
    ASSERT_EQ(scene.input_mesh.V.row(v), scene.rig.mesh.V.row(scene.welded_of_input[v])) << v;
  }
  ASSERT_EQ(scene.input_mesh.F.rows(), scene.rig.mesh.F.rows());
  for (int f = 0; f < scene.input_mesh.F.rows(); ++f) {
    for (int k = 0; k < 3; ++k)
      ASSERT_EQ(scene.welded_of_input[scene.input_mesh.F(f, k)], scene.rig.mesh.F(f, k)) << f;
  }
}

TEST(SkinningScene, BodyLoadsWeldedClosedAndRigged) {
  SkinningSceneOptions options;
  options.motion.joint = "knee-left";
  options.motion.to_deg = 120;
  options.motion.frames = 5;
  const auto scene = load(options);
  EXPECT_EQ(scene->rig.mesh.vertex_count(), 13380);  // welded, of 14,517
  EXPECT_EQ(scene->input_mesh.vertex_count(), 14517);
  EXPECT_TRUE(boundary_edges(scene->rig.mesh.F).empty());
  EXPECT_TRUE(non_manifold_edges(scene->rig.mesh.F).empty());
  validate(scene->rig.weights, 13380, scene->rig.skeleton.size());
  expect_split_follows_weld(*scene);
  EXPECT_THAT(scene->parameters(), testing::ElementsAre(0, 30, 60, 90, 120));
  ASSERT_EQ(scene->regions.size(), 1U);
  EXPECT_EQ(scene->regions[0].name, "knee-left");
  ASSERT_EQ(scene->warnings().size(), 2U);
  EXPECT_THAT(scene->warnings()[1],
              testing::AllOf(HasSubstr("left out"), HasSubstr("human-highpolyeyes")));
  EXPECT_EQ(scene->inputs().size(), 2U);
}

TEST(SkinningScene, RampOfZeroIsTheRestPoseAndTurnsAboutTheJoint) {
  SkinningSceneOptions options = cylinder();
  const auto scene = load(options);
  for (const Eigen::Affine3d& t : scene->pose_at(0))
    EXPECT_TRUE(t.matrix().isApprox(Eigen::Matrix4d::Identity(), 1e-15));
  // "flexion" of the cylinder carries +x towards -z by 90 degrees.
  const Eigen::Vector3d tip = scene->pose_at(90)[1] * Eigen::Vector3d(0.5, 0, 0);
  EXPECT_NEAR((tip - Eigen::Vector3d(0, 0, -0.5)).norm(), 0, 1e-12);
  EXPECT_THROW(static_cast<void>(scene->pose_at(45)), Error);
}

TEST(SkinningScene, LoopGoesOutAndReturnsByTheSamePoses) {
  SkinningSceneOptions options = cylinder();
  options.motion.kind = MotionKind::loop;
  const auto loop = load(options);
  options.motion.kind = MotionKind::ramp;
  const auto ramp = load(options);
  EXPECT_THAT(loop->parameters(), testing::ElementsAre(0, 1, 2, 3, 4, 5, 6));
  EXPECT_EQ(loop->parameter_name(), "step");
  EXPECT_EQ(loop->regions.size(), ramp->regions.size());
  for (int step = 0; step < 7; ++step) {
    const Pose& there = ramp->frame_pose[std::min(step, 6 - step)];
    for (std::size_t j = 0; j < there.size(); ++j)
      EXPECT_EQ(loop->pose_at(step)[j].matrix(), there[j].matrix()) << step;
  }
}

TEST(SkinningScene, SeamsFollowRefinementOfARegion) {
  SkinningSceneOptions options;
  options.motion.joint = "knee-left";
  options.motion.frames = 1;
  options.character.refine = {{.region = {"knee-left"}, .levels = 2}, {.region = {"all"}}};
  const auto scene = load(options);
  EXPECT_GT(scene->rig.mesh.vertex_count(), 4 * 13380);
  EXPECT_GT(scene->input_mesh.vertex_count(), scene->rig.mesh.vertex_count());
  EXPECT_TRUE(boundary_edges(scene->rig.mesh.F).empty());
  expect_split_follows_weld(*scene);
  validate(scene->rig.weights, scene->rig.mesh.vertex_count(), scene->rig.skeleton.size());
}

TEST(SkinningScene, SimplifiedBodyStaysClosedAndRigged) {
  SkinningSceneOptions options;
  options.motion.joint = "knee-left";
  options.character.simplify_to = 4000;
  const auto scene = load(options);
  EXPECT_NEAR(scene->rig.mesh.vertex_count(), 4000, 40);
  EXPECT_TRUE(boundary_edges(scene->rig.mesh.F).empty());
  expect_split_follows_weld(*scene);
  EXPECT_EQ(scene->regions.size(), 1U);
  options.character.weights = WeightSource::file;
  EXPECT_THROW(load(options), Error);
}

TEST(SkinningScene, NeighbouringJointsShareARegionOthersDoNot) {
  SkinningSceneOptions options;
  options.motion.joint = "index-1-left";
  options.motion.joints = {
      {.joint = "knee-right"}, {.joint = "index-3-left"}, {.joint = "index-2-left"}};
  const auto scene = load(options);
  ASSERT_EQ(scene->regions.size(), 2U);
  EXPECT_EQ(scene->regions[0].hinges.size(), 3U);
  EXPECT_EQ(scene->regions[1].name, "knee-right");
}

TEST(SkinningScene, WeightsComeFromTheCharacterOrFromTheFamilyAskedFor) {
  SkinningSceneOptions options = cylinder();
  std::vector<SkinWeights> families{load(options)->rig.weights};
  for (const WeightSource source :
       {WeightSource::heat, WeightSource::bounded, WeightSource::narrow}) {
    options.character.weights = source;
    const SkinWeights weights = load(options)->rig.weights;
    for (const SkinWeights& other : families) EXPECT_GT((weights - other).norm(), 0.1);
    families.push_back(weights);
  }
  SkinningSceneOptions body;
  body.motion.joint = "knee-left";
  body.character.weights = WeightSource::file;
  EXPECT_THAT(error_of(body), HasSubstr("no weights"));
}

TEST(SkinningScene, ClipOfASkinnedFileIsAMotion) {
  SkinningSceneOptions options;
  options.character.character = "glTF2/simple_skin/simple_skin.gltf";
  options.motion.kind = MotionKind::clip;
  options.motion.start_s = 1;
  options.motion.end_s = 2;
  options.motion.frames = 3;
  const auto scene = load(options);
  EXPECT_THAT(scene->parameters(), testing::ElementsAre(1, 1.5, 2));
  EXPECT_EQ(scene->parameter_unit(), "s");
  options.motion.end_s = 9;
  EXPECT_THAT(error_of(options), HasSubstr("within 0.0"));
  options.motion.end_s = 2;
  options.motion.name = "walk";
  EXPECT_THAT(error_of(options), HasSubstr("no clip 'walk'"));
}

TEST(SkinningScene, ForeignSkinnedFileIsConvertedAndMoves) {
  SkinningSceneOptions options;
  options.character.character = "animation_with_skeleton.glb";
  options.motion.kind = MotionKind::clip;
  options.motion.frames = 3;
  const auto scene = load(options);
  EXPECT_EQ(scene->rig.mesh.vertex_count(), 1058);
  EXPECT_GT(scene->input_mesh.vertex_count(), 1058);
  expect_split_follows_weld(*scene);
}

// Three parts and their open seams, mouth and eyes, made one closed skin at set-up; the weights are
// the file's.
TEST(SkinningScene, SecondCharacterIsClosedAndKeepsItsWeights) {
  SkinningSceneOptions options;
  options.character.character = "bcn_epileptic.glb";
  options.character.weights = WeightSource::file;
  options.motion.kind = MotionKind::clip;
  options.motion.frames = 3;
  const auto scene = load(options);
  EXPECT_EQ(scene->rig.skeleton.size(), 54);
  EXPECT_EQ(scene->rig.mesh.vertex_count(), 2591);
  EXPECT_TRUE(boundary_edges(scene->rig.mesh.F).empty());
  EXPECT_TRUE(non_manifold_edges(scene->rig.mesh.F).empty());
  EXPECT_GT(signed_volume(scene->rig.mesh.V, scene->rig.mesh.F), 0);
  expect_split_follows_weld(*scene);
}

TEST(SkinningScene, PosesOfTheBodyArePlausible) {
  SkinningSceneOptions options;
  options.motion.kind = MotionKind::poses;
  options.motion.file = "human.poses.toml";
  options.motion.names = {"sit", "deep-squat"};
  const auto scene = load(options);
  const Skeleton& skeleton = scene->rig.skeleton;
  const auto head = [&](double parameter, const char* name) -> Eigen::Vector3d {
    const std::size_t j = skeleton.index_of(name);
    return scene->pose_at(parameter)[j] * skeleton.joints[j].head;
  };
  // Sitting: thighs level within 10 degrees of their 0.41 m, shanks upright.
  EXPECT_NEAR(head(0, "knee-left").y(), head(0, "hip-left").y(), 0.07);
  EXPECT_NEAR(head(0, "knee-left").z(), head(0, "ankle-left").z(), 0.07);
  EXPECT_LT(head(1, "hip-left").y() - head(1, "ankle-left").y(), 0.45);  // 0.79 when standing
  options.motion.names = {"fly"};
  EXPECT_THAT(error_of(options), testing::AllOf(HasSubstr("no pose 'fly'"), HasSubstr("sit")));
}

TEST(SkinningScene, CapturedMotionIsSampledByFrames) {
  SkinningSceneOptions options;
  options.motion.kind = MotionKind::bvh;
  options.motion.file = "BVH/01_01.bvh";
  options.motion.first_frame = 100;
  options.motion.last_frame = 340;
  options.motion.stride = 120;
  options.regions = {"knee-left", "elbow-right"};
  const auto scene = load(options);
  ASSERT_EQ(scene->parameters().size(), 3U);
  EXPECT_NEAR(scene->parameters()[1], 220 / 120.0, 1e-4);  // 120 frames a second
  EXPECT_EQ(scene->regions.size(), 2U);
  options.motion.last_frame = 99999;
  EXPECT_THAT(error_of(options), HasSubstr("at most 2751"));
}

TEST(SkinningScene, BadScenesNameWhatIsWrong) {
  SkinningSceneOptions unskinned;
  unskinned.character.character = "glTF2/BoxTextured-glTF-Binary/BoxTextured.glb";
  unskinned.motion.joint = "a";
  EXPECT_THAT(error_of(unskinned), HasSubstr("no skin, and the scene names no skeleton file"));
  SkinningSceneOptions missing;
  missing.character.character = "nobody.glb";
  EXPECT_THAT(error_of(missing), HasSubstr("nobody.glb: no such file"));
  EXPECT_THAT(error_of(cylinder("knee")),
              testing::AllOf(HasSubstr("no joint 'knee'"), HasSubstr("upper")));
  SkinningSceneOptions still = cylinder();
  still.motion.to_deg = still.motion.from_deg;
  EXPECT_THAT(error_of(still), HasSubstr("does not change"));
  SkinningSceneOptions none = cylinder();
  none.motion.joint.reset();
  EXPECT_THAT(error_of(none), HasSubstr("turns no joint"));
  SkinningSceneOptions capture = cylinder();
  capture.motion.kind = MotionKind::bvh;
  capture.motion.file = "BVH/01_01.bvh";
  EXPECT_THAT(error_of(capture), HasSubstr("needs a skeleton file"));
}

}  // namespace
}  // namespace geoprior::skinning
