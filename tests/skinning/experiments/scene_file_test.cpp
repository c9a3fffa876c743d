// What a [scene] table says of a user's own files: skeleton, animation, the axis that is up.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "experiments/skinning/scene/scene.h"
#include "experiments/skinning/topic.h"
#include "tests/testbed/formats/gltf_samples.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::skinning {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

constexpr const char* kMine = "character = \"my.glb\"\n";

class SkinningSceneFile : public test::RunTest {
 protected:
  [[nodiscard]] std::shared_ptr<SkinningScene> scene(const std::string& scene_lines) const {
    const auto file = write_experiment(
        "skinning/mine", "title = \"Mine\"\ntopic = \"skinning\"\n[scene]\n" + scene_lines +
                             "\n[[variant]]\nname = \"a\"\nmethod = \"linear-blend\"\n");
    const Experiment experiment = load_experiment(file, {make_topic()}, {});
    const auto loaded = make_topic().load(*experiment.cases[0].scene, file.parent_path(), 1);
    return std::dynamic_pointer_cast<SkinningScene>(loaded);
  }
  [[nodiscard]] std::string error(const std::string& scene_lines) const {
    return test::error_of([&] { static_cast<void>(scene(scene_lines)); });
  }
  /// A file beside the experiment.
  void write(const std::string& name, const std::string& text) const {
    const auto path = folder() / "experiments" / "skinning" / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
  }
  void write_character(const test::GltfSample& sample) const {
    const std::vector<std::byte> bytes = sample.bytes();
    write("my.glb", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
};

TEST_F(SkinningSceneFile, SkeletonGivesTheAxesThatTheCharactersOwnHasNot) {
  write_character(test::skinned_square());
  write("my.skeleton.toml",
        "[joint.hip]\nhead = [0, 0, 0]\ntail = [0, 1, 0]\n"
        "[joint.knee]\nparent = \"hip\"\nhead = [0, 1, 0]\naxes = { flexion = \"+z\" }\n");
  const std::string bend = "motion = { joint = \"knee\", frames = 2 }\nregions = [\"hip\"]\n";
  EXPECT_THAT(error(kMine + bend), HasSubstr("no axis 'flexion'"));
  const auto turned = scene(kMine + bend + "skeleton = \"my.skeleton.toml\"\n");
  // About +z, 90 degrees carry the knee's (1, 1, 0) to (0, 2, 0).
  const Eigen::Vector3d corner = turned->pose_at(90)[1] * Eigen::Vector3d(1, 1, 0);
  EXPECT_NEAR((corner - Eigen::Vector3d(0, 2, 0)).norm(), 0, 1e-12);
}

TEST_F(SkinningSceneFile, ClipIsTheAnimationOfThatName) {
  test::GltfSample two = test::skinned_square();
  two.json["animations"].push_back(two.json["animations"][0]);
  two.json["animations"][1]["name"] = "bend back";
  const float h = std::sqrt(0.5F);
  two.json["animations"][1]["samplers"][0]["output"] =
      two.accessor<float>({0, 0, 0, 1, 0, 0, -h, h}, "VEC4", 4, 5126);
  write_character(two);
  const auto corner = [&](const std::string& name) {
    const auto clip = scene(kMine + ("motion = { kind = \"clip\", frames = 2" + name + " }"));
    return Eigen::Vector3d(clip->pose_at(1)[1] * Eigen::Vector3d(1, 1, 0));
  };
  EXPECT_NEAR((corner("") - Eigen::Vector3d(0, 2, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR((corner(", name = \"bend back\"") - Eigen::Vector3d(0, 0, 0)).norm(), 0, 1e-6);
  EXPECT_THAT(error(kMine + std::string("motion = { kind = \"clip\", name = \"fly\" }")),
              AllOf(HasSubstr("no clip 'fly'"), HasSubstr("bend, bend back")));
}

/// The square whose knee a clip scales by 2 along y, in one second.
test::GltfSample growing_square() {
  test::GltfSample s = test::skinned_square();
  s.json["animations"][0]["samplers"][0]["output"] =
      s.accessor<float>({1, 1, 1, 1, 2, 1}, "VEC3", 3, 5126);
  s.json["animations"][0]["channels"][0]["target"]["path"] = "scale";
  return s;
}

// Linear blend would scale the skin, dual quaternions would not: no comparison of one motion.
TEST_F(SkinningSceneFile, ClipThatScalesAJointIsRefusedOrStripped) {
  write_character(growing_square());
  const std::string clip = "motion = { kind = \"clip\", frames = 2";
  for (const std::string said : {"", ", joint_scale = \"refuse\""}) {
    EXPECT_THAT(error(kMine + clip + said + " }"),
                AllOf(HasSubstr("my.glb: the clip 'bend' scales joint 'knee' by 2 at 1 s"),
                      HasSubstr("dual quaternions"), HasSubstr("joint_scale = \"strip\"")));
  }
  const auto stripped = scene(kMine + clip + ", joint_scale = \"strip\" }");
  for (const Eigen::Affine3d& t : stripped->pose_at(1))
    EXPECT_TRUE(t.isApprox(Eigen::Affine3d::Identity(), 1e-12));
  EXPECT_THAT(stripped->warnings(), Contains(HasSubstr("scales joint 'knee' by 2 at 1 s; it is "
                                                       "played without scale")));
  EXPECT_EQ(scene(kMine + clip + ", end_s = 0.0001, joint_scale = \"refuse\" }")->warnings().size(),
            0U)
      << "of the frames that are played";
}

// A joint that is twice as large in the file's nodes as when it was bound, and turns by the clip.
TEST_F(SkinningSceneFile, ScaleThatStandsInTheNodesIsStrippedAboutTheHead) {
  test::GltfSample s = test::skinned_square();
  s.json["nodes"][2]["scale"] = {2, 2, 2};
  write_character(s);
  const std::string clip = "motion = { kind = \"clip\", frames = 2";
  EXPECT_THAT(error(kMine + clip + " }"), HasSubstr("scales joint 'knee' by 2 at 0 s"));
  const auto stripped = scene(kMine + clip + ", joint_scale = \"strip\" }");
  const Eigen::Vector3d corner = stripped->pose_at(1)[1] * Eigen::Vector3d(1, 1, 0);
  EXPECT_NEAR((corner - Eigen::Vector3d(0, 2, 0)).norm(), 0, 1e-6);
}

/// An arm of two bones, upright in the axis `offset` of the file; in the second frame its root
/// stands at (3, 0, 2) and is turned by 90 degrees about the file's z.
std::string captured_arm(const std::string& offset) {
  return "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition "
         "Zrotation Yrotation Xrotation\nJOINT Knee\n{\nOFFSET " +
         offset + "\nCHANNELS 3 Yrotation Xrotation Zrotation\nEnd Site\n{\nOFFSET " + offset +
         "\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.5\n0 0 0  0 0 0  0 0 0\n"
         "3 0 2  90 0 0  0 0 0\n";
}

class CapturedArm : public SkinningSceneFile {
 protected:
  /// The root's transform in a frame.
  [[nodiscard]] Eigen::Affine3d root(const std::string& offset, const std::string& motion_lines,
                                     double time) const {
    write_character(test::skinned_square());
    write("my.skeleton.toml",
          "[joint.hip]\nhead = [0, 0, 0]\ntail = [0, 1, 0]\nbvh = \"Hips\"\n"
          "[joint.knee]\nparent = \"hip\"\nhead = [0, 1, 0]\ntail = [0, 2, 0]\nbvh = \"Knee\"\n");
    write("my.bvh", captured_arm(offset));
    const auto captured = scene(
        kMine + ("skeleton = \"my.skeleton.toml\"\nmotion = { kind = \"bvh\", file = \"my.bvh\"" +
                 motion_lines + " }\n"));
    return captured->pose_at(time)[0];
  }
};

// A line of two bones does not tell which axis is up: the file's y, unless the scene says so.
TEST_F(CapturedArm, IsTurnedByTheAxisThatIsUp) {
  const auto turned = [&](const std::string& offset, const std::string& up) {
    return Eigen::Vector3d(root(offset, up, 0.5).linear() * Eigen::Vector3d::UnitX());
  };
  // A quarter turn about the file's z: about the mesh's z, or about its y where z is up.
  EXPECT_NEAR((turned("0 4 0", "") - Eigen::Vector3d::UnitY()).norm(), 0, 1e-9);
  EXPECT_NEAR((turned("0 4 0", ", bvh_up = \"y\"") - Eigen::Vector3d::UnitY()).norm(), 0, 1e-9);
  EXPECT_NEAR((turned("0 0 4", ", bvh_up = \"z\"") + Eigen::Vector3d::UnitZ()).norm(), 0, 1e-9);
  // Where x is up, z is horizontal, and a turn about it lays the upright arm down.
  EXPECT_NEAR((root("4 0 0", ", bvh_up = \"x\"", 0.5).linear() * Eigen::Vector3d::UnitY()).y(), 0,
              1e-9);
}

TEST_F(CapturedArm, StandsOverTheOriginInTheFrameAskedFor) {
  const auto beside = [&](const std::string& origin, double time) {
    const Eigen::Vector3d at = root("0 4 0", origin, time).translation();
    return std::hypot(at.x(), at.z());
  };
  EXPECT_NEAR(beside("", 0), 0, 1e-12);
  EXPECT_GT(beside("", 0.5), 0.1);
  EXPECT_NEAR(beside(", origin_frame = 1", 0.5), 0, 1e-12);
  EXPECT_NEAR(beside(", origin_frame = 1", 0), beside("", 0.5), 1e-12);
}

/// A leg of two bones, 2 m long, hanging from (0, 2, 0), and its motion in centimetres: at rest,
/// then raised by 50, with the knee bent by 90 degrees.
class CapturedLeg : public SkinningSceneFile {
 protected:
  /// @param offset   of the root
  /// @param heights  of its channels in both frames
  [[nodiscard]] std::shared_ptr<SkinningScene> leg(const std::string& offset,
                                                   const std::string& first,
                                                   const std::string& second,
                                                   const std::string& motion_lines) const {
    write_character(test::skinned_square());
    write("my.skeleton.toml",
          "[joint.hip]\nhead = [0, 2, 0]\ntail = [0, 1, 0]\nbvh = \"Hips\"\n"
          "[joint.knee]\nparent = \"hip\"\nhead = [0, 1, 0]\ntail = [0, 0, 0]\nbvh = \"Knee\"\n");
    write("my.bvh",
          "HIERARCHY\nROOT Hips\n{\nOFFSET 0 " + offset +
              " 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
              "JOINT Knee\n{\nOFFSET 0 -100 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
              "End Site\n{\nOFFSET 0 -100 0\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.5\n"
              "0 " +
              first + " 0 0 0 0  0 0 0\n0 " + second + " 0 0 0 0  0 90 0\n");
    return scene(kMine +
                 ("skeleton = \"my.skeleton.toml\"\nmotion = { kind = \"bvh\", file = \"my.bvh\"" +
                  motion_lines + " }\n"));
  }
  /// Height (m) by which the root is off its rest in a frame.
  [[nodiscard]] static double raised(const SkinningScene& scene, double time) {
    return scene.pose_at(time)[0].translation().y();
  }
};

// What the file says means two heights: the root at rest, or 2 m above it.
TEST_F(CapturedLeg, StandsWhereTheRootsOffsetIsAddedOrReplaced) {
  const auto added = leg("200", "200", "250", ", bvh_root = \"added\"");
  EXPECT_NEAR(raised(*added, 0), 2, 1e-9);
  EXPECT_NEAR(raised(*added, 0.5), 2.5, 1e-9);
  const auto replaced = leg("200", "200", "250", ", bvh_root = \"replaced\"");
  EXPECT_NEAR(raised(*replaced, 0), 0, 1e-9);
  EXPECT_NEAR(raised(*replaced, 0.5), 0.5, 1e-9);
  EXPECT_NEAR(raised(*leg("200", "0", "50", ", bvh_root = \"added\""), 0.5), 0.5, 1e-9);
  for (const auto& named : {added, replaced})
    for (const std::string& warning : named->warnings())
      EXPECT_THAT(warning, testing::Not(HasSubstr("bvh_root"))) << "nothing was guessed";
}

TEST_F(CapturedLeg, IsGuessedToStandOnTheGround) {
  const auto holds = leg("200", "200", "250", "");
  EXPECT_NEAR(raised(*holds, 0), 0, 1e-9);
  EXPECT_THAT(holds->warnings(),
              Contains(AllOf(HasSubstr("my.bvh: guessed bvh_root = \"replaced\""),
                             HasSubstr("stands at a height of 0, else of 200"))));
  const auto adds = leg("200", "0", "50", ", bvh_root = \"guess\"");
  EXPECT_NEAR(raised(*adds, 0.5), 0.5, 1e-9);
  EXPECT_THAT(adds->warnings(), Contains(HasSubstr("guessed bvh_root = \"added\"")));
  // An offset that is no leg's: by the channels alone.
  const auto high = leg("900", "0", "50", "");
  EXPECT_NEAR(raised(*high, 0.5), 7.5, 1e-9);
  EXPECT_THAT(high->warnings(), Contains(HasSubstr("mostly 0, that of the OFFSET 900")));
  EXPECT_NEAR(raised(*leg("900", "900", "950", ""), 0.5), 7.5, 1e-9);
  for (const std::string& warning : leg("0", "200", "250", "")->warnings())
    EXPECT_THAT(warning, testing::Not(HasSubstr("bvh_root"))) << "it makes no difference";
}

}  // namespace
}  // namespace geoprior::skinning
