#include "experiments/skinning/bvh/bvh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "experiments/skinning/bvh/up.h"
#include "experiments/skinning/scene/characters.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::skinning {
namespace {

using testing::HasSubstr;

/// A hip with one leg of two bones hanging down 4 and 3 units; two frames: rest, and the hip turned
/// by 90 degrees about z while the knee bends 90 about x.
const std::string kLeg = R"(HIERARCHY
ROOT Hips
{
  OFFSET 0 10 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT Knee
  {
    OFFSET 0 -4 0
    CHANNELS 3 Yrotation Xrotation Zrotation
    End Site
    {
      OFFSET 0 -3 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.5
0 0 0  0 0 0  0 0 0
1 2 3  90 0 0  0 90 0
)";

std::string bvh_error(const std::string& text) {
  return test::error_of([&] { parse_bvh(text, "test.bvh"); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

SkeletonFile leg_skeleton(const std::string& knee_tail, const std::string& align) {
  return parse_skeleton(
      "[joint.hip]\nhead = [0, 0.9, 0]\ntail = [0, 0.5, 0]\nbvh = \"Hips\"\n"
      "[joint.knee]\nparent = \"hip\"\nhead = [0, 0.5, 0]\ntail = " +
          knee_tail + "\nbvh = \"Knee\"\nbvh_align = " + align + "\n",
      "leg.toml");
}

TEST(Bvh, ReadsHierarchyAndChannels) {
  const BvhMotion motion = parse_bvh(kLeg, "leg.bvh");
  ASSERT_EQ(motion.joints.size(), 2U);
  EXPECT_EQ(motion.joints[1].parent, 0);
  EXPECT_EQ(motion.joints[1].first_column, 6);
  EXPECT_EQ(*motion.joints[1].end_site, Eigen::Vector3d(0, -3, 0));
  EXPECT_EQ(motion.frame_count(), 2);
  EXPECT_EQ(motion.frame_time_s, 0.5);
}

TEST(Bvh, RotationsMultiplyInTheOrderOfTheChannels) {
  const BvhFrame frame = bvh_frame(parse_bvh(kLeg, "leg.bvh"), 1);
  // The hip turns -y to +x, so that the knee lies 4 units along x from the moved root.
  EXPECT_NEAR((frame.position[1] - Eigen::Vector3d(5, 12, 3)).norm(), 0, 1e-12);
  // The knee's own turn about x carries -y to -z, which the hip's turn about z leaves.
  const Eigen::Vector3d shank = frame.rotation[1] * Eigen::Vector3d(0, -1, 0);
  EXPECT_NEAR((shank - Eigen::Vector3d(0, 0, -1)).norm(), 0, 1e-12);
}

TEST(Bvh, RestFrameLeavesAnAlignedSkeletonAtRest) {
  const BvhMotion motion = parse_bvh(kLeg, "leg.bvh");
  const SkeletonFile skeleton = leg_skeleton("[0, 0.2, 0]", "true");
  const Pose pose = BvhRetarget(motion, skeleton, 0).pose(0);
  for (const Eigen::Affine3d& t : pose) {
    EXPECT_TRUE(t.linear().isApprox(Eigen::Matrix3d::Identity(), 1e-12));
    EXPECT_NEAR(t.translation().x(), 0, 1e-12);
    EXPECT_NEAR(t.translation().z(), 0, 1e-12);
  }
}

TEST(Bvh, RestBonesOfAnotherDirectionAreAlignedFirst) {
  const BvhMotion motion = parse_bvh(kLeg, "leg.bvh");
  const SkeletonFile skeleton = leg_skeleton("[0.3, 0.5, 0]", "true");  // shank along x
  const Pose rest = BvhRetarget(motion, skeleton, 0).pose(0);
  EXPECT_NEAR((rest[1].linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d(0, -1, 0)).norm(), 0,
              1e-12);
  const Pose posed = BvhRetarget(motion, skeleton, 0).pose(1);
  EXPECT_NEAR((posed[1].linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d(0, 0, -1)).norm(), 0,
              1e-12);
  const Pose as_it_is = BvhRetarget(motion, leg_skeleton("[0.3, 0.5, 0]", "false"), 0).pose(0);
  EXPECT_TRUE(as_it_is[1].linear().isApprox(Eigen::Matrix3d::Identity(), 1e-12));
}

TEST(Bvh, JointsStayConnectedAndTheRootMovesScaled) {
  const BvhMotion motion = parse_bvh(kLeg, "leg.bvh");
  const SkeletonFile skeleton = leg_skeleton("[0, 0.2, 0]", "true");
  const BvhRetarget retarget(motion, skeleton, 0);
  const Pose a = retarget.pose(0);
  const Pose b = retarget.pose(1);
  const Eigen::Vector3d knee = skeleton.skeleton.joints[1].head;
  EXPECT_NEAR((b[0] * knee - b[1] * knee).norm(), 0, 1e-12);
  // Legs of 0.4 m (hip above the lowest joint) against 4 units: 0.1 m a unit.
  const Eigen::Vector3d hip = skeleton.skeleton.joints[0].head;
  EXPECT_NEAR((b[0] * hip - a[0] * hip - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 0, 1e-12);
}

TEST(Bvh, UnknownJointsOfTheMotionAreNamed) {
  const BvhMotion motion = parse_bvh(kLeg, "leg.bvh");
  SkeletonFile skeleton = leg_skeleton("[0, 0.2, 0]", "true");
  skeleton.bvh_joint[1] = "Shin";
  EXPECT_THROW(BvhRetarget(motion, skeleton, 0), Error);
  skeleton.bvh_joint = {std::nullopt, std::nullopt};
  EXPECT_THROW(BvhRetarget(motion, skeleton, 0), Error);
}

/// A motion as a file whose coordinates are turned: the world's y is the file's `up`.
BvhMotion with_up(BvhMotion motion, int up) {
  const auto turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), Eigen::Vector3d::Unit(up));
  for (BvhJoint& joint : motion.joints) {
    joint.offset = turn * joint.offset;
    if (joint.end_site) joint.end_site = turn * *joint.end_site;
    for (std::size_t c = 0; c < joint.channels.size(); ++c) {
      BvhChannel& channel = joint.channels[c];
      const Eigen::Vector3d axis = turn * Eigen::Vector3d::Unit(channel.axis);
      Eigen::Index where = 0;
      axis.cwiseAbs().maxCoeff(&where);
      channel.axis = static_cast<int>(where);
      if (axis[where] < 0) {
        motion.values.col(joint.first_column + c) *= -1;
      }
    }
  }
  return motion;
}

class CapturedMotion : public testing::Test {
 protected:
  const BvhMotion captured_ = read_bvh(test_models_folder() / "BVH/01_01.bvh");
  const SkeletonFile skeleton_ = read_skeleton_file(find_input("human.skeleton.toml", "."));

  BvhMotion stand(const BvhMotion& motion, BvhUp up) const {
    return stand_up(motion, skeleton_, up, 0, "walk.bvh");
  }
};

class BvhUpAxis : public CapturedMotion, public testing::WithParamInterface<int> {};

TEST_P(BvhUpAxis, IsGuessedAndGivesTheSamePoses) {
  const BvhMotion turned = with_up(captured_, GetParam());
  const auto named = static_cast<BvhUp>(static_cast<int>(BvhUp::x) + GetParam());
  const BvhMotion expected = stand(captured_, BvhUp::guess);
  for (const BvhUp up : {BvhUp::guess, named}) {
    const BvhMotion standing = stand(turned, up);
    for (const int frame : {0, 500, 1500}) {
      const Pose a = BvhRetarget(expected, skeleton_, 0).pose(frame);
      const Pose b = BvhRetarget(standing, skeleton_, 0).pose(frame);
      for (std::size_t j = 0; j < a.size(); ++j) EXPECT_TRUE(a[j].isApprox(b[j], 1e-9)) << frame;
    }
  }
}

TEST_P(BvhUpAxis, AnotherThatLaysTheBodyDownIsRefused) {
  const BvhMotion turned = with_up(captured_, GetParam());
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == GetParam()) continue;
    const auto wrong = static_cast<BvhUp>(static_cast<int>(BvhUp::x) + axis);
    EXPECT_THAT(test::error_of([&] { stand(turned, wrong); }),
                testing::AllOf(HasSubstr("walk.bvh: with bvh_up = \""),
                               HasSubstr("the body would lie down"), HasSubstr("bvh_up: \"x\"")));
  }
}

INSTANTIATE_TEST_SUITE_P(Axes, BvhUpAxis, testing::Values(0, 1, 2));

TEST_F(CapturedMotion, ABodyOnItsHeadIsRefusedWithEveryAxis) {
  BvhMotion motion = captured_;
  for (BvhJoint& joint : motion.joints) joint.offset.y() *= -1;
  for (const BvhUp up : {BvhUp::guess, BvhUp::y}) {
    EXPECT_THAT(test::error_of([&] { stand(motion, up); }), HasSubstr("walk.bvh: with bvh_up"));
  }
  EXPECT_THAT(test::error_of([&] { stand(motion, BvhUp::y); }), HasSubstr("stand on its head"));
}

TEST(BvhUpOfALine, IsWhatTheFileSays) {
  const BvhMotion motion = parse_bvh(kLeg, "leg.bvh");
  const SkeletonFile leg = leg_skeleton("[0, 0.2, 0]", "true");
  EXPECT_TRUE(stand_up(motion, leg, BvhUp::guess, 0, "leg.bvh")
                  .to_y_up.isApprox(Eigen::Quaterniond::Identity(), 1e-15));
  EXPECT_TRUE((stand_up(motion, leg, BvhUp::z, 0, "leg.bvh").to_y_up * Eigen::Vector3d::UnitZ())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-12));
}

/// The notes of a text that is read to the same joints and numbers as kLeg.
std::vector<std::string> notes_of_same(const std::string& text) {
  const BvhMotion expected = parse_bvh(kLeg, "leg.bvh");
  BvhMotion motion;
  EXPECT_NO_THROW(motion = parse_bvh(text, "test.bvh")) << text;
  EXPECT_EQ(motion.values.leftCols(9).eval(), expected.values) << text;
  EXPECT_EQ(motion.frame_time_s, expected.frame_time_s) << text;
  EXPECT_EQ(motion.joints.size(), expected.joints.size()) << text;
  if (motion.joints.size() == 2) {
    EXPECT_EQ(motion.joints[1].end_site, expected.joints[1].end_site);
  }
  return motion.notes;
}

TEST(Bvh, KeywordsAreReadAsProgramsWriteThem) {
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"End Site", "End site"},
           {"End Site", "END SITE"},
           {"End Site", "EndSite"},
           {"End Site", "End Site ToeTip"},
           {"End Site\n    {", "End Site {"},
           {"Frames: 2", "Frames:2"},
           {"Frames: 2", "Frames : 2"},
           {"Frames: 2", "FRAMES:\t2"},
           {"Frame Time: 0.5", "Frame Time:0.5"},
           {"Frame Time: 0.5", "FrameTime : 5e-1"},
           {"Frame Time: 0.5", "Frame  Time:\t+.5"},
           {"HIERARCHY", "Hierarchy"},
           {"Zrotation Yrotation Xrotation", "ZROTATION YRotation xrotation"},
           {"ROOT Hips\n{", "ROOT Hips {"},
           {"ROOT Hips\n{", "root Hips{"}}) {
    EXPECT_THAT(notes_of_same(replaced(kLeg, from, to)), testing::IsEmpty()) << to;
  }
}

TEST(Bvh, NamesMayHaveBlanks) {
  const std::string text =
      replaced(replaced(kLeg, "Hips", "Bip01  Pelvis \t"), "Knee\n  {", "Bip01 L Calf {");
  const BvhMotion motion = parse_bvh(text, "test.bvh");
  EXPECT_EQ(motion.joints[0].name, "Bip01  Pelvis");
  EXPECT_EQ(motion.joints[1].name, "Bip01 L Calf");
  EXPECT_THAT(bvh_error(replaced(kLeg, "JOINT Knee", "JOINT")),
              HasSubstr("test.bvh:7: a joint without a name"));
}

TEST(Bvh, OfSeveralRootsTheFirstIsReadAndTheOthersAreNamed) {
  const std::string ball =
      "ROOT Ball\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\nJOINT Seam\n{\n"
      "OFFSET 0 1 0\nCHANNELS 0\n}\n}\n";
  std::string text = replaced(kLeg, "MOTION", ball + "root Flag\n{\nOFFSET 1 2 3\n}\nMOTION");
  text = replaced(text, "0 0 0\n1 2 3", "0 0 0  7 8 9\n1 2 3");
  text = replaced(text, "0 90 0\n", "0 90 0  7 8 9\n");
  EXPECT_THAT(notes_of_same(text),
              testing::ElementsAre("test.bvh: of 3 roots the first, 'Hips' of 2 joints, is read; "
                                   "left out: 'Ball' of 2 joints, 'Flag' of 1 joint"));
}

TEST(Bvh, OneRowTooManyIsNotedAndNoneMore) {
  const std::string row = "1 2 3  4 5 6  7 8 9\n";
  EXPECT_THAT(notes_of_same(kLeg + row),
              testing::ElementsAre(HasSubstr("one row of motion more than the 2")));
  EXPECT_THAT(bvh_error(kLeg + row + row), HasSubstr("more numbers than 2 frames"));
  EXPECT_THAT(bvh_error(kLeg + "1 2 3\n"), HasSubstr("more numbers than 2 frames"));
  EXPECT_THAT(bvh_error(kLeg + "thanks for reading\n"), HasSubstr("'thanks' is no number"));
  EXPECT_THAT(bvh_error(replaced(kLeg, "Frames: 2", "Frames: 3")), HasSubstr("the file"));
}

// A knee whose position channels say where it is, as its OFFSET does, and a little more.
TEST(Bvh, PositionChannelsOfJointsHoldTheirOffsetOrAreAdded) {
  const auto knee = [](const std::string& first, const std::string& second) {
    std::string text = replaced(kLeg, "CHANNELS 3 Y", "CHANNELS 6 Xposition Yposition Zposition Y");
    text = replaced(text, "0 0 0  0 0 0\n", "0 0 0  " + first + "  0 0 0\n");
    text = replaced(text, "90 0 0  0 90 0", "90 0 0  " + second + "  0 90 0");
    return parse_bvh(text, "test.bvh");
  };
  const BvhMotion held = knee("0 -4 0", "0 -4 0");
  EXPECT_NEAR((bvh_frame(held, 1).position[1] - Eigen::Vector3d(5, 12, 3)).norm(), 0, 1e-12);
  EXPECT_THAT(held.notes, testing::IsEmpty());
  const BvhMotion added = knee("0 0 0", "0 0 0");
  EXPECT_NEAR((bvh_frame(added, 1).position[1] - Eigen::Vector3d(5, 12, 3)).norm(), 0, 1e-12);
  EXPECT_THAT(
      knee("0 -4 0", "0 -5 0").notes,
      testing::ElementsAre(HasSubstr("position channels of joint 'Knee' stretch bones by up "
                                     "to 1: left out")));
}

TEST(Bvh, MistakesNameTheLine) {
  EXPECT_THAT(bvh_error(replaced(kLeg, "OFFSET 0 10 0", "OFFSET 0 ten 0")),
              HasSubstr("test.bvh:4: 'ten' is no number"));
  EXPECT_THAT(bvh_error(replaced(kLeg, "Xrotation Zrotation", "Xrotation Wrotation")),
              HasSubstr("test.bvh:9: channel 'Wrotation'"));
  EXPECT_THAT(bvh_error(replaced(kLeg, "CHANNELS 3", "CHANNELS 7")), HasSubstr("test.bvh:9"));
  EXPECT_THAT(bvh_error(replaced(kLeg, "End Site", "Site")), HasSubstr("test.bvh:10"));
  EXPECT_THAT(bvh_error(replaced(kLeg, "0 90 0\n", "0 90\n")), HasSubstr("the file ends"));
  EXPECT_THAT(bvh_error(replaced(kLeg, "0 90 0\n", "0 90 0 7\n")), HasSubstr("more numbers"));
  EXPECT_THAT(bvh_error(replaced(kLeg, "0 90 0\n", "0 nan 0\n")), HasSubstr("'nan'"));
  EXPECT_THAT(bvh_error(replaced(kLeg, "Time: 0.5", "Time: 0")), HasSubstr("frame time"));
  EXPECT_THAT(bvh_error(kLeg.substr(0, kLeg.find("MOTION"))), HasSubstr("the file ends"));
  EXPECT_THAT(bvh_error(""), HasSubstr("HIERARCHY"));
}

TEST(Bvh, CountsBeyondTheFileAllocateNothing) {
  EXPECT_THAT(bvh_error(replaced(kLeg, "Frames: 2", "Frames: 99999999")), HasSubstr("too short"));
  EXPECT_THAT(bvh_error(replaced(kLeg, "Frames: 2", "Frames: 1e30")), HasSubstr("out of range"));
}

TEST(Bvh, CapturedClipDrivesTheBody) {
  const BvhMotion motion = read_bvh(test_models_folder() / "BVH/01_01.bvh");
  EXPECT_EQ(motion.frame_count(), 2752);
  const SkeletonFile skeleton = read_skeleton_file(find_input("human.skeleton.toml", "."));
  const BvhRetarget retarget(motion, skeleton, 0);
  const auto place = [&](const Pose& pose, const char* name) -> Eigen::Vector3d {
    const int j = skeleton.skeleton.index_of(name);
    return pose[j] * skeleton.skeleton.joints[j].head;
  };
  // Frame 0 is the T-pose of the capture with arms lowered by 5 degrees (the file's numbers): our
  // A-pose arms are raised to it.
  const Pose t_pose = retarget.pose(0);
  for (const std::string side : {"-left", "-right"}) {
    const Eigen::Vector3d elbow = place(t_pose, ("elbow" + side).c_str());
    for (const std::string other : {"shoulder", "wrist"}) {
      const Eigen::Vector3d bone = place(t_pose, (other + side).c_str()) - elbow;
      EXPECT_NEAR(std::abs(bone.y()) / bone.norm(), std::sin(5 * std::numbers::pi / 180), 1e-6);
    }
  }
  EXPECT_GT(place(t_pose, "wrist-left").x() - place(t_pose, "shoulder-left").x(), 0.4);
  // Bones keep their lengths in any frame.
  const Pose later = retarget.pose(1500);
  EXPECT_NEAR((place(later, "knee-left") - place(later, "hip-left")).norm(),
              (place(t_pose, "knee-left") - place(t_pose, "hip-left")).norm(), 1e-9);
}

}  // namespace
}  // namespace geoprior::skinning
