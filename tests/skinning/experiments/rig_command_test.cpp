// The skeleton file that `geoprior rig` writes, and the flexion axes that it guesses.

#include "experiments/skinning/rig_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "experiments/skinning/scene/guess/axes.h"
#include "experiments/skinning/scene/characters.h"
#include "testbed/formats/gltf/reader.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::skinning {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Joint joint_at(const std::string& name, int parent, const Eigen::Vector3d& head) {
  return {name, parent, head, std::nullopt, {}};
}

/// Tails at the mean of the children's heads, as a glTF file has them.
Skeleton with_tails(Skeleton skeleton) {
  const auto children = skeleton.children();
  for (int j = 0; j < skeleton.size(); ++j) {
    if (children[j].empty()) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int c : children[j]) mean += skeleton.joints[c].head;
    skeleton.joints[j].tail = mean / static_cast<double>(children[j].size());
  }
  return skeleton;
}

/// The body of the repository with its authored axes taken away.
Skeleton human_without_axes() {
  Skeleton skeleton = read_skeleton_file(find_input("human.skeleton.toml", ".")).skeleton;
  for (Joint& joint : skeleton.joints) joint.axes.clear();
  return skeleton;
}

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 180 / M_PI;
}

std::string rig_text(const std::string& file) {
  return rig_command().run(file, TypedOptions<RigOptions>()).text;
}

TEST(AxisGuess, AgreesWithTheAuthoredFlexionOfTheBody) {
  const Skeleton authored = read_skeleton_file(find_input("human.skeleton.toml", ".")).skeleton;
  const std::vector<JointAxes> guessed = guess_axes(human_without_axes());
  for (const char* name :
       {"spine-1", "spine-2", "neck", "hip-left", "hip-right", "knee-left", "knee-right",
        "ankle-left", "elbow-left", "elbow-right", "shoulder-left", "wrist-left", "index-1-left",
        "index-2-left", "middle-2-left", "ring-2-right", "pinky-3-right"}) {
    const int j = authored.index_of(name);
    EXPECT_LT(degrees_between(guessed[j].flexion.direction, authored.joints[j].axes.at("flexion")),
              15)
        << name << ": " << guessed[j].flexion.reason;
  }
}

TEST(AxisGuess, JointsThatTwistAnArmMakeNoHand) {
  // The arm of the body with two joints along its upper bone, as riggers spread a twist.
  Skeleton body = human_without_axes();
  const std::vector<JointAxes> plain = guess_axes(body);
  const int shoulder = body.index_of("shoulder-left");
  const Joint upper = body.joints[shoulder];
  for (const double at : {0.3, 0.6}) {
    body.joints.push_back(joint_at("twist " + std::to_string(at), shoulder,
                                   upper.head + at * (*upper.tail - upper.head)));
  }
  const std::vector<JointAxes> with_twists = guess_axes(body);
  for (const char* name : {"shoulder-left", "elbow-left", "index-2-left"}) {
    const int j = body.index_of(name);
    EXPECT_LT(degrees_between(with_twists[j].flexion.direction, plain[j].flexion.direction), 10)
        << name << ": " << with_twists[j].flexion.reason;
  }
}

TEST(AxisGuess, DoesNotDependOnTheSideThatTheBodyFaces) {
  const Skeleton body = human_without_axes();
  const std::vector<JointAxes> facing_z = guess_axes(body);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  Skeleton turned = body;
  for (Joint& joint : turned.joints) {
    joint.head = turn * joint.head;
    if (joint.tail) joint.tail = turn * *joint.tail;
  }
  const std::vector<JointAxes> facing_x = guess_axes(turned);
  for (std::size_t j = 0; j < facing_z.size(); ++j) {
    EXPECT_LT(degrees_between(facing_x[j].flexion.direction, turn * facing_z[j].flexion.direction),
              1e-4)
        << body.joints[j].name;
  }
}

TEST(AxisGuess, BentLimbBendsFurtherAboutTheNormalOfItsPlane) {
  // Two bones in the plane of x and z, off any plane of symmetry: u x d = (0, 0, 1) x (1, 0, 1).
  const Skeleton limb = with_tails(
      {{joint_at("a", -1, {0, 0, 0}), joint_at("b", 0, {0, 0, 1}), joint_at("c", 1, {1, 0, 2})}});
  const JointAxes axes = guess_axes(limb)[1];
  EXPECT_TRUE(axes.flexion.direction.isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_THAT(axes.flexion.reason, HasSubstr("bent by 45° at rest"));
  EXPECT_TRUE(axes.twist.isApprox(Eigen::Vector3d(1, 0, 1).normalized(), 1e-12));
}

TEST(AxisGuess, TakesAnAxisOfTheJointsOwnThatIsNear) {
  Skeleton limb = with_tails(
      {{joint_at("a", -1, {0, 0, 0}), joint_at("b", 0, {0, 0, 1}), joint_at("c", 1, {1, 0, 2})}});
  // The guess is +y: an own axis 6 degrees off is taken, with its sign turned; one 20 off is not.
  for (const double off : {6.0, 20.0}) {
    limb.joints[1].frame =
        Eigen::AngleAxisd(off * M_PI / 180, Eigen::Vector3d::UnitX()).toRotationMatrix() *
        Eigen::Vector3d(1, -1, -1).asDiagonal();
    const JointAxes axes = guess_axes(limb)[1];
    EXPECT_NEAR(degrees_between(axes.flexion.direction, Eigen::Vector3d::UnitY()),
                off < 10 ? off : 0, 1e-6);
    EXPECT_EQ(axes.flexion.reason.find("local -y") != std::string::npos, off < 10);
    for (const GuessedAxis& other : axes.alternatives) {
      EXPECT_LT(std::abs(other.direction.dot(axes.twist)), 0.9);
    }
  }
}

TEST(AxisGuess, GivesUnitAxesToASkeletonThatSaysNothing) {
  for (const Skeleton& skeleton :
       {Skeleton{{joint_at("a", -1, {0, 0, 0})}},
        Skeleton{{joint_at("a", -1, {1, 1, 1}), joint_at("b", 0, {1, 1, 1})}}}) {
    for (const JointAxes& axes : guess_axes(skeleton)) {
      EXPECT_NEAR(axes.flexion.direction.norm(), 1, 1e-12);
      EXPECT_NEAR(axes.twist.norm(), 1, 1e-12);
      EXPECT_NEAR(axes.flexion.direction.dot(axes.twist), 0, 1e-12);
    }
  }
}

TEST(RigCommand, WritesWhatIsReadBackAsTheSameSkeleton) {
  for (const char* name : {"animation_with_skeleton.glb", "glTF2/simple_skin/simple_skin.gltf"}) {
    const Skeleton own = *read_gltf(find_input(name, ".")).skeleton;
    const Skeleton back = parse_skeleton(rig_text(name), name).skeleton;
    ASSERT_EQ(back.size(), own.size());
    for (int j = 0; j < own.size(); ++j) {
      const Joint& a = own.joints[j];
      const Joint& b = back.joints[j];
      EXPECT_EQ(b.name, a.name);
      EXPECT_EQ(b.parent, a.parent);
      EXPECT_LE((b.head - a.head).norm(), 1e-6 * (1 + a.head.norm())) << a.name;
      ASSERT_EQ(b.tail.has_value(), a.tail.has_value()) << a.name;
      EXPECT_TRUE(b.axes.contains("flexion"));
    }
  }
}

TEST(RigCommand, IsAcceptedForTheSameCharacterAndKeepsItsWeights) {
  const std::string name = "animation_with_skeleton.glb";
  const auto file = std::filesystem::temp_directory_path() / "geoprior-rig.skeleton.toml";
  std::ofstream(file) << rig_text(name);
  CharacterOptions options;
  options.character = name;
  const Character own = load_character(options, ".");
  options.skeleton = file.string();
  const Character helped = load_character(options, ".");
  std::filesystem::remove(file);
  EXPECT_EQ(helped.rig.skeleton.size(), own.rig.skeleton.size());
  EXPECT_LT((helped.rig.weights - own.rig.weights).norm(), 1e-12);
  EXPECT_EQ(helped.warnings, own.warnings);
}

TEST(RigCommand, QuotesNamesThatAreNoBareKeys) {
  const std::vector<std::string> names{"mixamorig:Hips", "a.b",         "\"quoted\"\\", "",
                                       "Bein-Ä",         "tab\tand\x7f"};
  Skeleton skeleton;
  for (int i = 0; i < std::ssize(names); ++i) {
    skeleton.joints.push_back(joint_at(names[i], i - 1, {0, static_cast<double>(i), 0}));
  }
  const Skeleton back = parse_skeleton(skeleton_file_text(with_tails(skeleton), "x"), "x").skeleton;
  ASSERT_EQ(back.size(), skeleton.size());
  for (int j = 0; j < back.size(); ++j) EXPECT_EQ(back.joints[j].name, names[j]);
}

TEST(RigCommand, SaysWhatItGuessedFromAndWhatElseItCouldBe) {
  EXPECT_THAT(rig_text("animation_with_skeleton.glb"),
              AllOf(HasSubstr("# flexion: "), HasSubstr("# axes = { flexion = "),
                    HasSubstr("  # local "), HasSubstr("geoprior describe skeleton")));
}

TEST(RigCommand, RefusesWhatHasNoSkeletonAndNamesWhatIsRead) {
  EXPECT_THAT(test::error_of([] { rig_text("glTF2/BoxTextured-glTF-Binary/BoxTextured.glb"); }),
              HasSubstr("no skin: the file has no skeleton"));
  EXPECT_THAT(test::error_of([] { rig_text("nofile.glb"); }),
              HasSubstr("nofile.glb: no such file"));
  EXPECT_THAT(test::error_of([] { rig_text("bunny.off"); }), HasSubstr("glTF 2.0 (.glb, .gltf)"));
}

TEST(RigCommand, ScalesToMetres) {
  TypedOptions<RigOptions> centimetres;
  centimetres.options.unit_m = 0.01;
  const std::string name = "animation_with_skeleton.glb";
  const Skeleton large = parse_skeleton(rig_text(name), name).skeleton;
  const Skeleton small = parse_skeleton(rig_command().run(name, centimetres).text, name).skeleton;
  for (int j = 0; j < large.size(); ++j) {
    EXPECT_TRUE(small.joints[j].head.isApprox(0.01 * large.joints[j].head, 1e-6));
  }
}

}  // namespace
}  // namespace geoprior::skinning
