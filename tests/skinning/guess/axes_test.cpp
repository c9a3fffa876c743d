// The flexion axes that the rest pose of a skeleton is guessed to have, and what is doubtful of
// them.

#include "experiments/skinning/scene/guess/axes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/skinning/scene/guess/body.h"
#include "experiments/skinning/scene/guess/hand.h"
#include "tests/skinning/guess/skeletons.h"

namespace geoprior::skinning {
namespace {

using fixtures::degrees_between;
using fixtures::human_without_axes;
using fixtures::joint_at;
using fixtures::with_tails;
using testing::HasSubstr;

/// The doubt of a joint by its name; empty where it is sure.
std::string doubt_of(const Skeleton& skeleton, const std::string& name) {
  return guess_axes(skeleton)[skeleton.index_of(name)].doubt.value_or("");
}

int doubts_in(const Skeleton& skeleton) {
  const std::vector<JointAxes> axes = guess_axes(skeleton);
  return static_cast<int>(
      std::count_if(axes.begin(), axes.end(), [](const JointAxes& joint) { return joint.doubt; }));
}

Skeleton turned_by(const Eigen::Matrix3d& turn, Skeleton skeleton) {
  for (Joint& joint : skeleton.joints) {
    joint.head = turn * joint.head;
    if (joint.tail) joint.tail = turn * *joint.tail;
  }
  return skeleton;
}

/// Without the joints whose names begin so; what hung on them is gone, too.
Skeleton without(const std::string& beginning, const Skeleton& skeleton) {
  Skeleton left;
  std::vector<int> place;
  for (const Joint& joint : skeleton.joints) {
    const bool is_gone =
        joint.name.starts_with(beginning) || (joint.parent >= 0 && place[joint.parent] < 0);
    place.push_back(is_gone ? -1 : left.size());
    if (is_gone) continue;
    left.joints.push_back(joint);
    if (joint.parent >= 0) left.joints.back().parent = place[joint.parent];
    left.joints.back().tail.reset();
  }
  return with_tails(left);
}

/// A hand of four straight fingers along -y, side by side along x, each of three joints, with the
/// bend of each joint towards +z, and a thumb.
Skeleton hand_alone(double bend_deg) {
  Skeleton hand{{joint_at("wrist", -1, {0, 0, 0})}};
  for (int k = 0; k < 4; ++k) {
    Eigen::Vector3d place(0.02 * k - 0.03, -0.09, 0);
    int parent = 0;
    for (int i = 0; i < 3; ++i) {
      hand.joints.push_back(
          joint_at("finger-" + std::to_string(k) + std::to_string(i), parent, place));
      parent = hand.size() - 1;
      const double angle = (i + 1) * bend_deg * M_PI / 180;
      place += 0.03 * Eigen::Vector3d(0, -std::cos(angle), std::sin(angle));
    }
  }
  hand.joints.push_back(joint_at("thumb-0", 0, {0.03, -0.02, 0.01}));
  hand.joints.push_back(joint_at("thumb-1", hand.size() - 1, {0.06, -0.05, 0.02}));
  return with_tails(hand);
}

/// A dog on +y, facing `front` (±1) along z: its hind legs are bent, its front legs straight, and
/// its paws point forward.
Skeleton dog(double front) {
  Skeleton dog{{joint_at("pelvis", -1, {0, 0.6, -0.4}), joint_at("spine", 0, {0, 0.62, 0}),
                joint_at("chest", 1, {0, 0.6, 0.4}), joint_at("head", 2, {0, 0.8, 0.6})}};
  for (const double x : {0.1, -0.1}) {
    const auto add = [&](const std::string& name, int parent, double y, double z) {
      const std::string side = x > 0 ? "-left" : "-right";
      dog.joints.push_back(joint_at(name + side, parent, {x, y, z}));
      return dog.size() - 1;
    };
    int at = add("stifle", add("hip", 0, 0.55, -0.4), 0.4, -0.3);
    add("claw", add("hind-paw", add("hock", at, 0.2, -0.45), 0.05, -0.4), 0.02, -0.3);
    at = add("elbow", add("shoulder", 2, 0.55, 0.35), 0.38, 0.35);
    add("toe", add("paw", at, 0.05, 0.35), 0.02, 0.45);
  }
  for (Joint& joint : dog.joints) joint.head.z() *= front;
  return with_tails(dog);
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

TEST(AxisGuess, IsSureOfABodyThatStands) {
  const Skeleton body = human_without_axes();
  for (const char* name :
       {"spine-1", "spine-2", "neck", "hip-left", "hip-right", "knee-left", "knee-right",
        "ankle-left", "elbow-left", "elbow-right", "shoulder-left", "wrist-left", "index-1-left",
        "index-2-left", "middle-2-left", "ring-2-right", "pinky-3-right"}) {
    EXPECT_EQ(doubt_of(body, name), "") << name;
  }
  EXPECT_THAT(doubt_of(body, "thumb-1-left"), HasSubstr("a thumb"));
}

TEST(AxisGuess, OfABodyThatLiesOrStandsOnAnyAxisTurnsWithIt) {
  const Skeleton body = human_without_axes();
  const std::vector<JointAxes> standing = guess_axes(body);
  for (int up = 0; up < 6; ++up) {
    for (int front = 0; front < 4; ++front) {
      Eigen::Matrix3d turn;
      turn.col(1) = (up < 3 ? 1 : -1) * Eigen::Vector3d::Unit(up % 3);
      turn.col(2) = (front < 2 ? 1 : -1) * Eigen::Vector3d::Unit((up + 1 + front % 2) % 3);
      turn.col(0) = turn.col(1).cross(turn.col(2));
      const std::vector<JointAxes> turned = guess_axes(turned_by(turn, body));
      for (std::size_t j = 0; j < standing.size(); ++j) {
        const Eigen::Vector3d expected = turn * standing[j].flexion.direction;
        EXPECT_LT(degrees_between(turned[j].flexion.direction, expected), 1e-4)
            << body.joints[j].name << ", up " << turn.col(1).transpose();
        EXPECT_EQ(turned[j].doubt, standing[j].doubt) << body.joints[j].name;
      }
    }
  }
}

TEST(AxisGuess, DoubtsTheFrontOfABodyWithoutFeet) {
  const Skeleton body = without("ankle", human_without_axes());
  for (const char* name : {"spine-1", "hip-left", "knee-right", "shoulder-left"})
    EXPECT_THAT(doubt_of(body, name), HasSubstr("no feet")) << name;
  EXPECT_EQ(doubt_of(body, "wrist-right"), "") << "its fingers are bent";
}

TEST(AxisGuess, DoubtsWhatHasNoMirrorImageButForClearBends) {
  const Skeleton limb =
      with_tails({{joint_at("a", -1, {0, 0, 0}), joint_at("b", 0, {0, 0, 1}),
                   joint_at("c", 1, {0.1, 0, 2}), joint_at("d", 2, {1, 0, 2.5})}});
  EXPECT_THAT(doubt_of(limb, "a"), HasSubstr("no mirror images"));
  EXPECT_THAT(doubt_of(limb, "b"), HasSubstr("no mirror images")) << "bent by 6 degrees";
  EXPECT_EQ(doubt_of(limb, "c"), "") << "bent by 55 degrees";
}

TEST(AxisGuess, DoubtsJointsThatAllHangOnTheRoot) {
  Skeleton flat = human_without_axes();
  for (int j = 0; j < flat.size(); ++j) {
    flat.joints[j].parent = j > 0 ? 0 : -1;
    flat.joints[j].tail.reset();
  }
  flat = with_tails(flat);
  EXPECT_EQ(doubts_in(flat), flat.size());
  for (Joint& joint : flat.joints) joint.parent = -1;
  EXPECT_EQ(doubts_in(flat), flat.size());
}

TEST(AxisGuess, AnAnimalsLegsBendAsTheyAreBentAndStraightOnesAreDoubtful) {
  for (const double front : {1.0, -1.0}) {
    const Skeleton animal = dog(front);
    const std::vector<JointAxes> axes = guess_axes(animal);
    const auto flexion = [&](const char* name) {
      return axes[animal.index_of(name)].flexion.direction;
    };
    // u x d: the stifle points forward and the hock backward.
    EXPECT_GT(front * flexion("stifle-left").x(), 0.9);
    EXPECT_LT(front * flexion("hock-right").x(), -0.9);
    EXPECT_GT(front * flexion("head").x(), 0.9) << "nods";
    for (const char* name : {"stifle-left", "hock-right", "spine", "head"})
      EXPECT_EQ(doubt_of(animal, name), "") << name;
    for (const char* name : {"shoulder-left", "elbow-right", "hip-left"})
      EXPECT_THAT(doubt_of(animal, name), HasSubstr("4 legs")) << name;
  }
}

TEST(HandGuess, IsAtTheEndOfALimbWithFingersSideBySide) {
  const Skeleton body = human_without_axes();
  const auto children = body.children();
  for (int j = 0; j < body.size(); ++j) {
    const Joint& joint = body.joints[j];
    const Eigen::Vector3d bone = (joint.tail.value_or(joint.head) - joint.head).stableNormalized();
    EXPECT_EQ(find_hand(body, children, j, bone).has_value(), joint.name.starts_with("wrist"))
        << joint.name;
  }
}

TEST(HandGuess, APelvisAChestAndARootWithFourLegsAreNone) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  // Joints without branches below: three or four chains that a hand could have.
  for (const auto& ends : std::vector<std::vector<Eigen::Vector3d>>{
           {{0, 0.7, 0}, {0.1, -0.9, 0}, {-0.1, -0.9, 0}},  // spine and legs
           {{0, 0.3, 0}, {0.7, 0.1, 0}, {-0.7, 0.1, 0}},    // neck and arms
           {{0, 0.3, 0}, {0.5, -0.5, 0}, {-0.5, -0.5, 0}},  // neck and hanging arms
           {{0.2, -0.6, 0.3}, {-0.2, -0.6, 0.3}, {0.2, -0.6, -0.3}, {-0.2, -0.6, -0.3}}}) {
    Skeleton skeleton{{joint_at("root", -1, {0, 0, 0})}};
    for (const Eigen::Vector3d& end : ends) {
      const std::string name = "chain-" + std::to_string(skeleton.size());
      skeleton.joints.push_back(joint_at(name, 0, 0.3 * end));
      skeleton.joints.push_back(joint_at(name + "-end", skeleton.size() - 1, end));
    }
    EXPECT_FALSE(find_hand(skeleton, skeleton.children(), 0, up)) << ends.size() << " chains";
  }
}

TEST(HandGuess, AHandAloneClosesToTheSideThatItsFingersAreBentTo) {
  for (const double side : {1.0, -1.0}) {
    const Skeleton hand = hand_alone(5 * side);
    const std::vector<JointAxes> axes = guess_axes(hand);
    for (const char* name : {"wrist", "finger-00", "finger-11", "finger-32"}) {
      // Fingers along -y close towards the side along z about -x.
      EXPECT_LT(side * axes[hand.index_of(name)].flexion.direction.x(), -0.95) << name;
      EXPECT_EQ(doubt_of(hand, name), "") << name;
    }
    EXPECT_THAT(doubt_of(hand, "thumb-0"), HasSubstr("a thumb"));
  }
  EXPECT_THAT(doubt_of(hand_alone(0), "finger-11"), HasSubstr("a hand alone"));
}

TEST(HandGuess, AHandAloneIsNoBodyThoughItsFingersAreMirrorImages) {
  EXPECT_FALSE(find_body(hand_alone(5)).is_symmetric);
  EXPECT_TRUE(find_body(human_without_axes()).is_symmetric);
}

}  // namespace
}  // namespace geoprior::skinning
