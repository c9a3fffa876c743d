// What a user's own rig meets: literal axes, skeleton files that help it, units, the camera.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "experiments/skinning/scene/literal_axis.h"
#include "experiments/skinning/scene/scene.h"
#include "tests/testbed/formats/gltf_samples.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::skinning {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class UserRig : public test::ScratchFolder {
 protected:
  void SetUp() override {
    ScratchFolder::SetUp();
    write_character(test::skinned_square());
  }

  void write_character(const test::GltfSample& sample) const {
    write("my.glb", test::text_of(sample.bytes()));
  }
  void write_skeleton(const std::string& text) const { write("my.skeleton.toml", text); }
  /// The square's knee, turned by 90 degrees.
  [[nodiscard]] static SkinningSceneOptions scene(const std::string& axis = "+z") {
    SkinningSceneOptions options;
    options.character.character = "my.glb";
    options.motion.joint = "knee";
    options.motion.axis = axis;
    options.motion.frames = 2;
    options.regions = {"hip"};  // of a root there is none: a square is no limb
    return options;
  }
  [[nodiscard]] static SkinningSceneOptions helped(const std::string& axis = "flexion") {
    SkinningSceneOptions options = scene(axis);
    options.character.skeleton = "my.skeleton.toml";
    return options;
  }
  [[nodiscard]] std::shared_ptr<SkinningScene> load(const SkinningSceneOptions& options) const {
    return load_skinning_scene(options, folder());
  }
  [[nodiscard]] std::string error(const SkinningSceneOptions& options) const {
    return test::error_of([&] { static_cast<void>(load(options)); });
  }
};

TEST(LiteralAxis, HasASpaceASignAndALetter) {
  EXPECT_EQ(parse_literal_axis("+x")->direction, Eigen::Vector3d::UnitX());
  EXPECT_EQ(parse_literal_axis("world -y")->direction, -Eigen::Vector3d::UnitY());
  EXPECT_FALSE(parse_literal_axis("world -y")->is_local);
  EXPECT_EQ(parse_literal_axis("local +z")->direction, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(parse_literal_axis("local +z")->is_local);
  for (const char* text : {"", "x", "+w", "+xy", "+X", "local", "local x", "local  +x", "world",
                           "global +x", "local world +x", "+x "}) {
    EXPECT_FALSE(parse_literal_axis(text)) << text;
  }
}

TEST_F(UserRig, LiteralAxesNeedNoSkeletonFile) {
  // About +z, 90 degrees carry the knee's (1, 1, 0) to (0, 2, 0).
  const auto turned = load(scene("+z"));
  EXPECT_NEAR((turned->pose_at(90)[1] * Eigen::Vector3d(1, 1, 0) - Eigen::Vector3d(0, 2, 0)).norm(),
              0, 1e-12);
  const auto back = load(scene("world -z"));
  EXPECT_NEAR((back->pose_at(90)[1] * Eigen::Vector3d(1, 1, 0) - Eigen::Vector3d(0, 0, 0)).norm(),
              0, 1e-12);
}

TEST_F(UserRig, LocalAxesAreThoseOfTheJointsFrame) {
  // The knee's frame turned by 90 degrees about y: its x axis is the mesh's -z.
  test::GltfSample turned = test::skinned_square();
  const float c = std::sqrt(0.5F);
  turned.json["nodes"][2]["rotation"] = {0, c, 0, c};
  // Inverse of the frame: rest x to joint z, z to -x, and the head at y = 1 to the origin.
  const std::vector<float> inverse{0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, -1, 0, 1};
  const std::size_t view = turned.json["accessors"][4]["bufferView"];
  const std::size_t offset = turned.json["bufferViews"][view]["byteOffset"];
  std::memcpy(turned.binary.data() + offset + 64, inverse.data(), 64);
  write_character(turned);
  const auto local = load(scene("local +x"));
  const auto world = load(scene("-z"));
  EXPECT_TRUE(local->pose_at(90)[1].isApprox(world->pose_at(90)[1], 1e-6));
}

TEST_F(UserRig, AnAxisThatIsNoneListsWhatIsAllowed) {
  for (const char* axis : {"x", "+w", "local", "flexion"}) {
    EXPECT_THAT(error(scene(axis)),
                AllOf(HasSubstr("joint 'knee': no axis '" + std::string(axis) + "'"),
                      HasSubstr("\"+x\" … \"-z\" (of the mesh)"), HasSubstr("\"local +x\""),
                      HasSubstr("a name that a skeleton file gives")));
  }
  write_skeleton(
      "[joint.hip]\nhead = [0, 0, 0]\n[joint.knee]\nparent = \"hip\"\n"
      "head = [0, 1, 0]\naxes = { flexion = \"+x\" }\n");
  EXPECT_THAT(error(helped("twist")), AllOf(HasSubstr("flexion, \"+x\"")));
}

TEST_F(UserRig, LocalAxesOfASkeletonWithoutFramesAreRefused) {
  SkinningSceneOptions options = scene("local +x");
  options.character.character = "cylinder";
  options.motion.joint = "upper";
  EXPECT_THAT(error(options),
              AllOf(HasSubstr("joint 'upper': has no axes of its own"), HasSubstr("\"+x\"")));
}

TEST_F(UserRig, PosesMayNameLiteralAxes) {
  write("my.poses.toml", "[pose.bent]\nknee = { \"local +z\" = 90 }\n");
  SkinningSceneOptions options = scene();
  options.motion = {};
  options.motion.kind = MotionKind::poses;
  options.motion.file = "my.poses.toml";
  const auto posed = load(options);
  EXPECT_TRUE(posed->pose_at(0)[1].isApprox(load(scene("+z"))->pose_at(90)[1], 1e-12));
}

TEST_F(UserRig, WeightsOfJointsThatTheFileLacksAreKeptWithANotice) {
  write_skeleton("[joint.knee]\nhead = [0, 1, 0]\naxes = { flexion = \"+z\" }\n");
  const auto own = load(scene());
  const auto scene = load(helped());
  EXPECT_THAT(
      scene->load_warnings,
      testing::ElementsAre(AllOf(HasSubstr("my.skeleton.toml lacks joints that carry weights"),
                                 HasSubstr("kept: 'hip'"))));
  ASSERT_EQ(scene->rig.skeleton.size(), 2);
  // The knee still hangs on the hip, and every vertex follows what it followed.
  const Skeleton& skeleton = scene->rig.skeleton;
  EXPECT_EQ(skeleton.joints[skeleton.index_of("knee")].parent, skeleton.index_of("hip"));
  for (const char* name : {"hip", "knee"}) {
    const Eigen::VectorXd ours = scene->rig.weights.col(skeleton.index_of(name));
    const Eigen::VectorXd theirs = own->rig.weights.col(own->rig.skeleton.index_of(name));
    EXPECT_EQ(ours, theirs) << name;
  }
}

TEST_F(UserRig, AFileThatSharesNoJointReplacesTheRig) {
  write_skeleton("[joint.stem]\nhead = [0, 0, 0]\ntail = [0, 1, 0]\n");
  SkinningSceneOptions options = helped("+z");
  options.motion.joint = "stem";
  options.character.weights = WeightSource::file;
  EXPECT_THAT(error(options), HasSubstr("no weights for the joints of the skeleton"));
}

TEST_F(UserRig, AFileThatMakesACircleWithTheRigIsRefused) {
  // In the file the hip hangs on the knee, in the rig the knee on the thigh and that on the hip.
  test::GltfSample three = test::skinned_square();
  three.json["nodes"][1]["children"] = {3};
  three.json["nodes"].push_back({{"name", "thigh"}, {"children", {2}}});
  three.json["skins"][0]["joints"] = {1, 2, 3};
  std::vector<float> bind(48, 0);
  for (std::size_t m = 0; m < 3; ++m)
    for (std::size_t i = 0; i < 4; ++i) bind[16 * m + 5 * i] = 1;
  bind[16 + 13] = -1;
  three.json["skins"][0]["inverseBindMatrices"] = three.accessor<float>(bind, "MAT4", 16, 5126);
  three.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = three.accessor<std::uint8_t>(
      {0, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4, 5121);
  write_character(three);
  write_skeleton(
      "[joint.hip]\nparent = \"knee\"\nhead = [0, 0, 0]\n[joint.knee]\nhead = [0, 1, 0]\n");
  EXPECT_THAT(error(helped("+z")),
              AllOf(HasSubstr("my.skeleton.toml"), HasSubstr("is its own ancestor")));
}

TEST_F(UserRig, SkeletonOfAnotherUnitIsRefusedWithTheRatio) {
  for (const double factor : {0.1, 10.0}) {
    const std::string y = std::to_string(factor);
    write_skeleton("[joint.hip]\nhead = [0, 0, 0]\ntail = [0, " + y +
                   ", 0]\n[joint.knee]\nparent = \"hip\"\nhead = [0, " + y + ", 0]\n");
    EXPECT_THAT(error(helped("+z")), AllOf(HasSubstr("my.skeleton.toml: the skeleton is " +
                                                     std::string(factor < 1 ? "0.1" : "10") +
                                                     " times as large as that of the character"),
                                           HasSubstr("unit_m")));
    // A cylinder 1 m long and 0.2 m thick (diagonal 1.04 m) against bones of 1 m times the factor.
    SkinningSceneOptions options = helped("+z");
    options.character.character = "cylinder";
    options.motion.joint = "b";
    write_skeleton("[joint.a]\nhead = [0, 0, 0]\n[joint.b]\nparent = \"a\"\nhead = [" + y +
                   ", 0, 0]\n");
    EXPECT_THAT(error(options),
                AllOf(HasSubstr(" times as large as the mesh"), HasSubstr("allowed: 0.15 to 3")));
  }
}

TEST_F(UserRig, AMeshFileSaysWhatACharacterIsReadFrom) {
  write("my.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  SkinningSceneOptions options = scene();
  options.character.character = "my.obj";
  EXPECT_THAT(error(options), AllOf(HasSubstr("my.obj: is no file that a character is read from"),
                                    HasSubstr(".glb, .gltf"), HasSubstr("skeleton = ")));
}

Eigen::Vector3d vector_of(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

TEST_F(UserRig, DefaultPictureLooksAlongTheAxisAtTheJoint) {
  const auto square = load(scene("+z"));
  ASSERT_TRUE(square->camera());
  EXPECT_TRUE(vector_of(square->camera()->target).isApprox(Eigen::Vector3d(0, 1, 0), 1e-12));
  EXPECT_NEAR(std::abs(vector_of(square->camera()->direction).z()), 1, 1e-12);
}

TEST(DefaultPicture, ShowsTheKneeFromTheOutsideOfTheBody) {
  SkinningSceneOptions options;
  options.motion.joint = "knee-left";
  options.motion.frames = 2;
  const auto scene = load_skinning_scene(options, ".");
  const Camera camera = scene->camera().value();
  const Skeleton& skeleton = scene->rig.skeleton;
  const Joint& knee = skeleton.joints[skeleton.index_of("knee-left")];
  EXPECT_TRUE(vector_of(camera.target).isApprox(knee.head, 1e-12));
  // The body's left is +x; knees flex about +x.
  EXPECT_GT(vector_of(camera.direction).x(), 0.9);
  // Between a third of the shank and the whole leg.
  EXPECT_GT(camera.height_m, 0.13);
  EXPECT_LT(camera.height_m, 0.8);
}

TEST(DefaultPicture, ATwistIsSeenFromBesideTheBone) {
  SkinningSceneOptions options;
  options.motion.joint = "elbow-left";
  options.motion.axis = "twist";
  options.motion.frames = 2;
  const auto scene = load_skinning_scene(options, ".");
  const Joint& elbow = scene->rig.skeleton.joints[scene->rig.skeleton.index_of("elbow-left")];
  const Eigen::Vector3d bone = (*elbow.tail - elbow.head).normalized();
  EXPECT_LT(std::abs(vector_of(scene->camera()->direction).dot(bone)), 0.1);
}

TEST(DefaultPicture, OfAClipIsTheWholeBody) {
  SkinningSceneOptions options;
  options.character.character = "animation_with_skeleton.glb";
  options.motion.kind = MotionKind::clip;
  options.motion.frames = 2;
  EXPECT_FALSE(load_skinning_scene(options, ".")->camera());
}

}  // namespace
}  // namespace geoprior::skinning
