#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "experiments/skinning/scene/characters.h"
#include "experiments/skinning/scene/skeleton_file.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::skinning {
namespace {

using testing::HasSubstr;

std::string skeleton_error(const std::string& text) {
  return test::error_of([&] { parse_skeleton(text, "test.toml"); });
}

const SkeletonFile& human() {
  static const SkeletonFile file = read_skeleton_file(find_input("human.skeleton.toml", "."));
  return file;
}

const Joint& human_joint(const std::string& name) {
  return human().skeleton.joints[human().skeleton.index_of(name)];
}

/// Where the tail of `joint` goes when an axis of it turns by a small angle.
Eigen::Vector3d motion_of_tail(const std::string& joint, const std::string& axis) {
  const Joint& j = human_joint(joint);
  return j.axes.at(axis).cross(*j.tail - j.head);
}

TEST(SkeletonFile, ParentsComeFirstInWhateverOrderTheyStand) {
  const SkeletonFile file = parse_skeleton(R"(
    [joint.tip]
    parent = "middle"
    head = [0, 2, 0]
    [joint.middle]
    parent = "root"
    head = [0, 1, 0]
    tail = [0, 2, 0]
    axes = { flexion = "-x", twist = [0, 3, 4] }
    bvh = "Leg"
    bvh_align = false
    [joint.root]
    head = [0, 0, 0])",
                                           "test.toml");
  ASSERT_EQ(file.skeleton.size(), 3);
  EXPECT_EQ(file.skeleton.joints[0].name, "root");
  EXPECT_EQ(file.skeleton.joints[1].name, "middle");
  EXPECT_EQ(file.skeleton.joints[2].parent, 1);
  EXPECT_FALSE(file.skeleton.joints[0].tail);
  EXPECT_EQ(file.skeleton.joints[1].axes.at("flexion"), -Eigen::Vector3d::UnitX());
  EXPECT_TRUE(file.skeleton.joints[1].axes.at("twist").isApprox(Eigen::Vector3d(0, 0.6, 0.8)));
  EXPECT_EQ(file.bvh_joint[1], "Leg");
  EXPECT_FALSE(file.bvh_align[1]);
  EXPECT_TRUE(file.bvh_align[0]);
}

TEST(SkeletonFile, MistakesNameFileLineAndWhatIsAllowed) {
  EXPECT_THAT(skeleton_error("[joint.a]\nhead = [0, 0, 0]\nlength = 3\n"),
              testing::AllOf(HasSubstr("test.toml:3"), HasSubstr("'length'"), HasSubstr("tail")));
  EXPECT_THAT(skeleton_error("[bone.a]\nhead = [0, 0, 0]\n"), HasSubstr("test.toml:1"));
  EXPECT_THAT(skeleton_error("[joint.a]\nhead = [0, 0]\n"), HasSubstr("test.toml:2: 'head'"));
  EXPECT_THAT(skeleton_error("[joint.a]\nhead = [0, 0, nan]\n"), HasSubstr("test.toml:2: 'head'"));
  EXPECT_THAT(skeleton_error("[joint.a]\ntail = [0, 0, 1]\n"), HasSubstr("has no 'head'"));
  EXPECT_THAT(skeleton_error("[joint.a]\nhead = [0, 0, 0]\ntail = [0, 0, 0]\n"),
              HasSubstr("coincide"));
  EXPECT_THAT(skeleton_error("[joint.a]\nhead = [0, 0, 0]\naxes = { flexion = \"x\" }\n"),
              testing::AllOf(HasSubstr("test.toml:3"), HasSubstr("+x")));
  EXPECT_THAT(skeleton_error("[joint.a]\nhead = [0, 0, 0]\naxes = { flexion = [0, 0, 0] }\n"),
              HasSubstr("no direction"));
  EXPECT_THAT(skeleton_error("[joint.a]\nhead = [0, 0, 0]\nparent = \"b\"\n"),
              HasSubstr("no joint 'b'"));
  EXPECT_THAT(skeleton_error("[joint.a]\nhead = [0,\n"), HasSubstr("no valid TOML"));
  EXPECT_THAT(skeleton_error(""), HasSubstr("no joints"));
}

TEST(SkeletonFile, CyclicParentsNameTheJoint) {
  EXPECT_THAT(skeleton_error("[joint.a]\nhead = [0, 0, 0]\nparent = \"b\"\n"
                             "[joint.b]\nhead = [0, 1, 0]\nparent = \"a\"\n"),
              HasSubstr("joint 'a' is its own ancestor"));
  EXPECT_THAT(skeleton_error("[joint.a]\nhead = [0, 0, 0]\nparent = \"a\"\n"),
              HasSubstr("joint 'a' is its own ancestor"));
}

TEST(PoseFile, KeepsTheOrderOfAnglesAndRefusesUnknownAxes) {
  const auto poses = parse_poses(
      "[pose.b]\nknee = { twist = 1, flexion = -2.5 }\n[pose.a]\nhip = { flexion = 3 }\n",
      "p.toml");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].name, "b");
  ASSERT_EQ(poses[0].angles.size(), 2U);
  EXPECT_EQ(poses[0].angles[0].axis, "twist");
  EXPECT_EQ(poses[0].angles[1].angle_deg, -2.5);
  EXPECT_THROW(joint_rotation(human().skeleton, {"knee-left", "wobble", 1}), Error);
  EXPECT_THROW(joint_rotation(human().skeleton, {"knee", "flexion", 1}), Error);
  EXPECT_THROW(parse_poses("[pose.a]\nknee = 3\n", "p.toml"), Error);
}

TEST(HumanSkeleton, HasEveryJointOfTheBody) {
  for (const std::string side : {"-left", "-right"}) {
    for (const char* name :
         {"clavicle", "shoulder", "elbow", "wrist", "hip", "knee", "ankle", "toe"})
      EXPECT_TRUE(human_joint(name + side).tail) << name << side;
    for (const char* finger : {"thumb", "index", "middle", "ring", "pinky"}) {
      for (const char* phalanx : {"-1", "-2", "-3"})
        EXPECT_TRUE(human_joint(finger + std::string(phalanx) + side).axes.count("flexion"));
    }
  }
}

TEST(HumanSkeleton, RightMirrorsLeft) {
  const Eigen::Vector3d mirror(-1, 1, 1);
  for (const Joint& left : human().skeleton.joints) {
    if (!left.name.ends_with("-left")) continue;
    const Joint& right =
        human_joint(left.name.substr(0, left.name.size() - 5) + std::string("-right"));
    EXPECT_EQ(right.head, left.head.cwiseProduct(mirror)) << left.name;
    EXPECT_EQ(*right.tail, left.tail->cwiseProduct(mirror)) << left.name;
    for (const auto& [name, axis] : left.axes) {  // axes are pseudo-vectors
      EXPECT_TRUE(right.axes.at(name).isApprox(-axis.cwiseProduct(mirror), 1e-9))
          << left.name << " " << name;
    }
  }
}

TEST(HumanSkeleton, PositiveAnglesTurnTheNaturalWay) {
  for (const std::string side : {"-left", "-right"}) {
    const double outwards = side == "-left" ? 1 : -1;
    EXPECT_LT(motion_of_tail("knee" + side, "flexion").z(), 0);
    EXPECT_GT(motion_of_tail("hip" + side, "flexion").z(), 0);
    EXPECT_GT(motion_of_tail("hip" + side, "abduction").x() * outwards, 0);
    EXPECT_GT(motion_of_tail("ankle" + side, "flexion").y(), 0);
    EXPECT_GT(motion_of_tail("shoulder" + side, "flexion").z(), 0);
    EXPECT_GT(motion_of_tail("shoulder" + side, "abduction").y(), 0);
    EXPECT_GT(motion_of_tail("elbow" + side, "flexion").z(), 0);
    // The palms look at the body and down: fingers close that way.
    for (const char* finger : {"index-1", "middle-2", "ring-3", "pinky-1"}) {
      const Eigen::Vector3d motion = motion_of_tail(finger + side, "flexion");
      EXPECT_LT(motion.x() * outwards, 0) << finger << side;
      EXPECT_LT(motion.y(), 0) << finger << side;
    }
  }
  EXPECT_GT(motion_of_tail("spine-2", "flexion").z(), 0);
}

}  // namespace
}  // namespace geoprior::skinning
