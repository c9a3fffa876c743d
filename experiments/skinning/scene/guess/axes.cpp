#include "experiments/skinning/scene/guess/axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "experiments/skinning/scene/guess/body.h"
#include "experiments/skinning/scene/guess/hand.h"

namespace geoprior::skinning {
namespace {

using Eigen::Vector3d;

constexpr double kBend = 3;          ///< degrees; less is a straight limb
constexpr double kFolded = 150;      ///< degrees; more is no bend of a limb
constexpr double kClearBend = 20;    ///< degrees; less may be a limb that is bent to its side
constexpr double kAgree = 25;        ///< degrees between such a bend and the straight limb's axis
constexpr double kContradicts = 45;  ///< degrees between them that leave a doubt
constexpr double kSlightBend = 8;    ///< degrees; less is no sign of another side
constexpr double kForward = 0.95;    ///< cosine; a bone that points so far forward turns up
constexpr double kKneeHighest = 0.25, kKneeLowest = 0.85;  ///< of a knee, down the leg
constexpr double kStub = 0.1;       ///< reach of a limb, over the body's size
constexpr double kHandReach = 0.2;  ///< of a hand, over the body's size
constexpr double kSnap = 10;        ///< degrees between a guess and an axis of the joint's own
constexpr double kAlongBone = 0.9;  ///< cosine; about such an axis a bone twists

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

double angle_between(const Vector3d& a, const Vector3d& b) {
  return degrees(std::atan2(a.cross(b).norm(), a.dot(b)));
}

std::string degrees_text(double angle) { return std::to_string(std::lround(angle)) + "°"; }

/// A guess, and why it may be wrong; absent: it is not.
struct Flexion {
  GuessedAxis axis;
  std::optional<std::string> doubt;
};

/// The joints of a skeleton as the guess walks over them.
class Rig {
 public:
  explicit Rig(const Skeleton& skeleton)
      : skeleton_(skeleton), children_(skeleton.children()), body_(find_body(skeleton)) {
    for (int j = 0; j < skeleton.size(); ++j) {
      bone_.push_back(bone_direction(j));
      add_to_limb(j);
      hand_.push_back(hand_of(j));
    }
    lowest_.resize(joints().size());
    for (int j = skeleton.size() - 1; j >= 0; --j) {
      lowest_[j] = body_.up.dot(joints()[j].head);
      for (const int child : children_[j]) lowest_[j] = std::min(lowest_[j], lowest_[child]);
    }
    is_flat_ = skeleton.size() > 2 &&
               std::none_of(joints().begin(), joints().end(), [&](const Joint& joint) {
                 return joint.parent >= 0 && joints()[joint.parent].parent >= 0;
               });
  }

  [[nodiscard]] const Vector3d& bone(int joint) const { return bone_[joint]; }

  [[nodiscard]] Flexion flexion(int joint) const {
    if (bends_with_trunk(joint)) return flexion_of_trunk();
    auto closing = flexion_of_hand(joint);
    Flexion found = bent_or(closing ? std::move(*closing) : flexion_of_straight(joint), joint);
    if (is_flat_) {
      found.doubt = "no joint hangs on another but the root";
    } else if (!knows_bone(joint)) {
      found.doubt = "nothing shows where its bone points";
    } else if (!found.doubt && is_stub(joint)) {
      found.doubt = "what hangs there is too short for a limb";
    }
    return found;
  }

 private:
  [[nodiscard]] const std::vector<Joint>& joints() const { return skeleton_.joints; }

  [[nodiscard]] bool bends_with_trunk(int joint) const {
    return !is_flat_ && body_.in_plane(joints()[joint].head) &&
           std::abs(body_.left.dot(bone_[joint])) < kAlongBone;
  }

  [[nodiscard]] Flexion flexion_of_trunk() const {
    return {{body_.left, "in the plane of symmetry: the trunk bends forward"}, doubt_of_body()};
  }

  /// The bend of a limb that is bent at rest, where that is clear or agrees with the guess for a
  /// straight one.
  [[nodiscard]] Flexion bent_or(Flexion straight, int joint) const {
    const double angle = bend_angle(joint);
    if (angle < kBend || angle > kFolded) return straight;
    const std::string words = "bent by " + degrees_text(angle) + " at rest";
    Flexion bent{{before(joint).cross(bone_[joint]).normalized(), words + ": bends further"}, {}};
    const double apart = angle_between(bent.axis.direction, straight.axis.direction);
    const bool contradicts = !straight.doubt && apart > kContradicts;
    if (angle > kClearBend) {
      if (contradicts) bent.doubt = "bent to another side than a straight limb bends";
      return bent;
    }
    if (apart < kAgree) {
      bent.doubt = std::move(straight.doubt);
      return bent;
    }
    if (contradicts && angle > kSlightBend && !hand_[joint]) {
      straight.axis.reason += ", though it is " + words;
      straight.doubt = "bent to another side at rest";
    }
    return straight;
  }

  [[nodiscard]] Flexion flexion_of_straight(int joint) const {
    const auto [direction, words] = goal(joint);
    Vector3d axis = bone_[joint].cross(direction);
    if (axis.norm() < 0.1) axis = bone_[joint].cross(body_.left);
    if (axis.norm() < 0.1) axis = bone_[joint].cross(body_.up);
    Flexion found{{axis.normalized(), "the bone turns " + words}, doubt_of_body()};
    if (!found.doubt && body_.legs > 2 && reaches_ground(joint))
      found.doubt = "of " + std::to_string(body_.legs) + " legs each may bend to its own side";
    return found;
  }

  /// Of a hand and what lies beyond it, and of the toes of a foot: about the line of its knuckles,
  /// to the palm's side.
  [[nodiscard]] std::optional<Flexion> flexion_of_hand(int joint) const {
    const std::optional<Hand>& hand = hand_[joint];
    if (!hand || (hand->joint == joint && reaches_ground(joint))) return std::nullopt;
    const Vector3d& bone = bone_[joint];
    const Vector3d axis = hand->knuckles - hand->knuckles.dot(bone) * bone;
    if (!(axis.norm() > 0.3)) return std::nullopt;  // a bone along the knuckles
    std::string words = "about the line of the knuckles, to the palm";
    std::optional<std::string> doubt = doubt_of_body();
    bool is_turned = axis.cross(bone).dot(palm(joint)) < 0;
    const bool is_against = hand->closing && hand->closing->dot(axis) < 0;
    if (doubt && hand->closing) {
      is_turned = is_against;
      words += ": as the fingers are bent at rest";
      doubt.reset();
    } else if (hand->closing && is_turned != is_against) {
      doubt = "the fingers are bent to the other side at rest";
    }
    if (is_of_thumb(*hand, joint)) doubt = "a thumb turns about more than the knuckles' line";
    return Flexion{{(is_turned ? -1 : 1) * axis.normalized(), words}, std::move(doubt)};
  }

  [[nodiscard]] bool is_of_thumb(const Hand& hand, int joint) const {
    if (joint == hand.joint) return false;
    int first = joint;
    while (joints()[first].parent != hand.joint) first = joints()[first].parent;
    return is_thumb(hand, skeleton_, chain_from(first, children_));
  }

  /// The hand that the joint is, or is beyond; those of a body are small and beside its trunk.
  [[nodiscard]] std::optional<Hand> hand_of(int joint) const {
    if (body_.in_plane(joints()[joint].head)) return std::nullopt;
    std::optional<Hand> own = find_hand(skeleton_, children_, joint, bone_[joint]);
    if (own && !(body_.is_symmetric && own->reach > kHandReach * body_.size)) return own;
    const int parent = joints()[joint].parent;
    return parent < 0 ? std::nullopt : hand_[parent];
  }

  /// Where the palm of an arm at the side of the body faces: down when the arm is stretched out,
  /// inwards when it hangs; the sole of a foot faces down.
  [[nodiscard]] Vector3d palm(int joint) const {
    if (reaches_ground(joint)) return -body_.up;
    const double side = body_.left.dot(joints()[joint].head) > body_.middle ? 1 : -1;
    const double out = side * body_.left.dot(bone_[joint]);
    const double up = body_.up.dot(bone_[joint]);
    return side * up * body_.left - out * body_.up;
  }

  /// Why the body's directions may be others than those found.
  [[nodiscard]] std::optional<std::string> doubt_of_body() const {
    return body_.up_doubt ? body_.up_doubt : body_.front_doubt;
  }

  [[nodiscard]] Vector3d bone_direction(int joint) const {
    const Joint& j = joints()[joint];
    const Vector3d own = j.tail ? (*j.tail - j.head).stableNormalized() : Vector3d::Zero();
    if (own.norm() > 0.5) return own;
    return j.parent < 0 ? body_.up : bone_[j.parent];
  }

  /// A leaf goes on as its parent's bone where that leads to it alone.
  [[nodiscard]] bool knows_bone(int joint) const {
    const Joint& j = joints()[joint];
    if (j.tail && (*j.tail - j.head).norm() > 0) return true;
    return j.parent >= 0 && children_[j.parent].size() == 1 && knows_bone(j.parent);
  }

  void add_to_limb(int joint) {
    const Joint& j = joints()[joint];
    const int above = j.parent < 0 ? -1 : limb_[j.parent];
    limb_.push_back(body_.in_plane(j.head) ? -1 : above < 0 ? joint : above);
    reach_.push_back(0);
    if (limb_[joint] < 0) return;
    const Vector3d end = j.tail.value_or(j.head);
    double& reach = reach_[limb_[joint]];
    reach = std::max(reach, (end - joints()[limb_[joint]].head).norm());
  }

  /// Of an ear, an eye or a pad: what hangs beside the plane of symmetry and reaches nowhere.
  [[nodiscard]] bool is_stub(int joint) const {
    return body_.is_symmetric && limb_[joint] >= 0 && reach_[limb_[joint]] < kStub * body_.size;
  }

  /// From the parent's head to the joint's.
  [[nodiscard]] Vector3d before(int joint) const {
    return (joints()[joint].head - joints()[joints()[joint].parent].head).stableNormalized();
  }

  /// Degrees at rest between a bone and its parent's, where no third bone leaves the joint and the
  /// parent belongs to the same limb; else 0.
  [[nodiscard]] double bend_angle(int joint) const {
    const Joint& j = joints()[joint];
    if (j.parent < 0 || !j.tail || children_[j.parent].size() != 1) return 0;
    if (body_.in_plane(joints()[j.parent].head)) return 0;
    return angle_between(before(joint), bone_[joint]);
  }

  /// Where a straight bone turns to.
  [[nodiscard]] std::pair<Vector3d, std::string> goal(int joint) const {
    const bool hangs = body_.up.dot(bone_[joint]) < -0.7;
    if (hangs && reaches_ground(joint) && is_at_knee(joint)) {
      return {-body_.front, "backward, as a knee"};
    }
    if (body_.front.dot(bone_[joint]) > kForward) return {body_.up, "up"};
    return {body_.front, "forward"};
  }

  [[nodiscard]] bool reaches_ground(int joint) const {
    return body_.is_symmetric && lowest_[joint] <= body_.lowest + Body::kFoot * body_.height;
  }

  /// Whether a joint of a leg is as far down as a knee: not where links of a hip follow one
  /// another, and above the ankle.
  [[nodiscard]] bool is_at_knee(int joint) const {
    if (limb_[joint] < 0) return false;
    const double top = body_.up.dot(joints()[limb_[joint]].head);
    const double down = top - body_.up.dot(joints()[joint].head);
    const double share = down / (top - lowest_[limb_[joint]]);
    return share > kKneeHighest && share < kKneeLowest;
  }

  const Skeleton& skeleton_;
  std::vector<std::vector<int>> children_;
  Body body_;
  std::vector<Vector3d> bone_;
  std::vector<int> limb_;  ///< for each joint the first of its limb; -1 in the plane of symmetry
  std::vector<double> reach_;              ///< of the limb, at its first joint
  std::vector<std::optional<Hand>> hand_;  ///< for each joint the hand that it is or is beyond
  std::vector<double> lowest_;             ///< of a joint and its descendants
  bool is_flat_ = false;
};

/// An axis of the joint's own frame, turned to the side of `towards`.
GuessedAxis own_axis(const Eigen::Matrix3d& frame, int axis, const Vector3d& towards) {
  const double sign = frame.col(axis).dot(towards) >= 0 ? 1 : -1;
  const std::string name = std::string(sign > 0 ? "+" : "-") + "xyz"[axis];
  return {sign * frame.col(axis), "local " + name};
}

JointAxes axes_of(const Joint& joint, const Vector3d& bone, Flexion guess) {
  JointAxes axes{std::move(guess.axis), bone, {}, std::move(guess.doubt)};
  const Vector3d first = axes.flexion.direction;
  bool snapped = false;
  for (int axis = 0; joint.frame && axis < 3; ++axis) {
    GuessedAxis own = own_axis(*joint.frame, axis, first);
    const double angle = angle_between(own.direction, first);
    if (std::abs(own.direction.dot(bone)) > kAlongBone) continue;
    if (angle > kSnap || snapped) {
      axes.alternatives.push_back(std::move(own));
    } else {
      snapped = true;
      axes.flexion = {own.direction, axes.flexion.reason + "; " + own.reason + ", " +
                                         degrees_text(angle) + " from that"};
    }
  }
  const Vector3d across = bone.cross(first);
  if (across.norm() > 0.1 && !snapped)
    axes.alternatives.push_back({across.normalized(), "across the bone and the guess"});
  return axes;
}

}  // namespace

std::vector<JointAxes> guess_axes(const Skeleton& skeleton) {
  const Rig rig(skeleton);
  std::vector<JointAxes> axes;
  for (int j = 0; j < skeleton.size(); ++j)
    axes.push_back(axes_of(skeleton.joints[j], rig.bone(j), rig.flexion(j)));
  return axes;
}

}  // namespace geoprior::skinning
