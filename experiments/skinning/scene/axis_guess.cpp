#include "experiments/skinning/scene/axis_guess.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace geoprior::skinning {
namespace {

using Eigen::Vector3d;

constexpr double kBend = 3;          ///< degrees; less is a straight limb
constexpr double kFolded = 150;      ///< degrees; more is no bend of a limb
constexpr double kClearBend = 20;    ///< degrees; less may be a limb that is bent to its side
constexpr double kAgree = 25;        ///< degrees between such a bend and the straight limb's axis
constexpr double kSnap = 10;         ///< degrees between a guess and an axis of the joint's own
constexpr double kAlongBone = 0.9;   ///< cosine; about such an axis a bone twists
constexpr double kHandWidth = 0.15;  ///< of the knuckles (deviation), over their distance
constexpr double kFoot = 0.15;       ///< share of the height that feet are in

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

double angle_between(const Vector3d& a, const Vector3d& b) {
  return degrees(std::atan2(a.cross(b).norm(), a.dot(b)));
}

std::string degrees_text(double angle) { return std::to_string(std::lround(angle)) + "°"; }

/// Where the body stands.
struct Body {
  Vector3d up = Vector3d::UnitY();
  Vector3d front = Vector3d::UnitZ();
  Vector3d left = Vector3d::UnitX();
  double middle = 0;     ///< of the plane of symmetry, along `left`
  double tolerance = 0;  ///< of mirror images (m)
  double lowest = 0;
  double height = 0;
  bool is_symmetric = false;

  [[nodiscard]] bool in_plane(const Vector3d& p) const {
    return is_symmetric && std::abs(left.dot(p) - middle) <= tolerance;
  }
};

/// The middle coordinate: of a body's joints that of its trunk, wherever the hands are.
double median(const Skeleton& skeleton, int axis) {
  std::vector<double> values;
  for (const Joint& joint : skeleton.joints) values.push_back(joint.head[axis]);
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

/// Joints off the plane (axis, offset) that have an image of another joint across it.
int mirrored_joints(const Skeleton& skeleton, int axis, double offset, double tolerance) {
  int count = 0;
  for (const Joint& joint : skeleton.joints) {
    if (std::abs(joint.head[axis] - offset) <= tolerance) continue;
    Vector3d image = joint.head;
    image[axis] = 2 * offset - image[axis];
    count += std::any_of(skeleton.joints.begin(), skeleton.joints.end(), [&](const Joint& other) {
      return (other.head - image).norm() <= tolerance;
    });
  }
  return count;
}

/// Direction of the lowest bones in the ground plane, summed.
Vector3d feet(const Skeleton& skeleton, const Body& body) {
  Vector3d sum = Vector3d::Zero();
  for (const Joint& joint : skeleton.joints) {
    if (joint.tail && joint.head.y() <= body.lowest + kFoot * body.height)
      sum += *joint.tail - joint.head;
  }
  sum.y() = 0;
  return sum;
}

Body find_body(const Skeleton& skeleton) {
  Eigen::AlignedBox3d box;
  for (const Joint& joint : skeleton.joints) box.extend(joint.head);
  Body body;
  body.lowest = box.min().y();
  body.height = box.sizes().y();
  body.tolerance = 0.02 * box.diagonal().norm();
  int most = 0;
  int sides = 0;
  for (const int axis : {0, 2}) {
    const int count = mirrored_joints(skeleton, axis, median(skeleton, axis), body.tolerance);
    if (count > most) sides = axis;
    most = std::max(most, count);
  }
  // A third of the joints that lie off the plane, and two pairs: one may be an accident.
  body.middle = median(skeleton, sides);
  const auto off_plane =
      std::count_if(skeleton.joints.begin(), skeleton.joints.end(), [&](const Joint& joint) {
        return std::abs(joint.head[sides] - body.middle) > body.tolerance;
      });
  body.is_symmetric = most >= 4 && 3 * most >= off_plane;
  if (!body.is_symmetric) return body;
  body.front = Vector3d::Unit(2 - sides);
  if (feet(skeleton, body).dot(body.front) < 0) body.front = -body.front;
  body.left = body.up.cross(body.front);
  body.middle *= body.left[sides];
  return body;
}

/// The joints of a skeleton as the guess walks over them.
class Rig {
 public:
  explicit Rig(const Skeleton& skeleton)
      : joints_(skeleton.joints), children_(skeleton.children()), body_(find_body(skeleton)) {
    for (int j = 0; j < skeleton.size(); ++j) bone_.push_back(bone_direction(j));
    lowest_.resize(joints_.size());
    for (int j = skeleton.size() - 1; j >= 0; --j) {
      lowest_[j] = joints_[j].head.y();
      for (const int child : children_[j]) lowest_[j] = std::min(lowest_[j], lowest_[child]);
    }
  }

  [[nodiscard]] const Vector3d& bone(int joint) const { return bone_[joint]; }

  [[nodiscard]] GuessedAxis flexion(int joint) const {
    if (body_.in_plane(joints_[joint].head) &&
        std::abs(body_.left.dot(bone_[joint])) < kAlongBone) {
      return {body_.left, "in the plane of symmetry: the trunk bends forward"};
    }
    GuessedAxis straight = flexion_of_straight(joint);
    const double angle = bend_angle(joint);
    if (angle < kBend || angle > kFolded) return straight;
    GuessedAxis bent{before(joint).cross(bone_[joint]).normalized(),
                     "bent by " + degrees_text(angle) + " at rest: bends further"};
    const bool agree = angle_between(bent.direction, straight.direction) < kAgree;
    return agree || angle > kClearBend ? bent : straight;
  }

 private:
  [[nodiscard]] GuessedAxis flexion_of_straight(int joint) const {
    if (const auto closing = flexion_of_hand(joint)) return *closing;
    const auto [direction, words] = goal(joint);
    Vector3d axis = bone_[joint].cross(direction);
    if (axis.norm() < 0.1) axis = bone_[joint].cross(body_.left);
    if (axis.norm() < 0.1) axis = bone_[joint].cross(body_.up);
    return {axis.normalized(), "the bone turns " + words};
  }

  /// Of a hand and what lies beyond it: about the line of its knuckles, to the palm's side.
  [[nodiscard]] std::optional<GuessedAxis> flexion_of_hand(int joint) const {
    const int hand = hand_of(joint);
    if (hand < 0) return std::nullopt;
    const Vector3d& bone = bone_[joint];
    const Vector3d line = knuckle_line(hand);
    const Vector3d axis = line - line.dot(bone) * bone;
    if (!(axis.norm() > 0.3)) return std::nullopt;  // a bone along the knuckles, or no hand
    const double side = axis.cross(bone).dot(palm(joint)) < 0 ? -1 : 1;
    return GuessedAxis{side * axis.normalized(), "about the line of the knuckles, to the palm"};
  }

  /// The joint itself or its nearest ancestor of the same limb that has three or more children; -1
  /// where there is none.
  [[nodiscard]] int hand_of(int joint) const {
    for (int j = joint; j >= 0 && !body_.in_plane(joints_[j].head); j = joints_[j].parent) {
      if (children_[j].size() >= 3) return j;
    }
    return -1;
  }

  /// The direction in which the children of a hand lie side by side; zero where they lie behind one
  /// another (joints that twist an arm).
  [[nodiscard]] Vector3d knuckle_line(int hand) const {
    const std::vector<int>& fingers = children_[hand];
    Vector3d mean = Vector3d::Zero();
    for (const int finger : fingers) mean += joints_[finger].head;
    mean /= static_cast<double>(fingers.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const int finger : fingers) {
      const Vector3d from_mean = joints_[finger].head - mean;
      const Vector3d across = from_mean - from_mean.dot(bone_[hand]) * bone_[hand];
      spread += across * across.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
    const double width = std::sqrt(axes.eigenvalues()[2] / static_cast<double>(fingers.size()));
    const bool is_wide = width > kHandWidth * (mean - joints_[hand].head).norm();
    return is_wide ? Vector3d(axes.eigenvectors().col(2)) : Vector3d::Zero();
  }

  /// Where the palm of an arm at the side of the body faces: down when the arm is stretched out,
  /// inwards when it hangs.
  [[nodiscard]] Vector3d palm(int joint) const {
    const double side = body_.left.dot(joints_[joint].head) > body_.middle ? 1 : -1;
    const double out = side * body_.left.dot(bone_[joint]);
    const double up = body_.up.dot(bone_[joint]);
    return side * up * body_.left - out * body_.up;
  }

  [[nodiscard]] Vector3d bone_direction(int joint) const {
    const Joint& j = joints_[joint];
    const Vector3d own = j.tail ? (*j.tail - j.head).stableNormalized() : Vector3d::Zero();
    if (own.norm() > 0.5) return own;
    return j.parent < 0 ? body_.up : bone_[j.parent];
  }

  /// From the parent's head to the joint's.
  [[nodiscard]] Vector3d before(int joint) const {
    return (joints_[joint].head - joints_[joints_[joint].parent].head).stableNormalized();
  }

  /// Degrees at rest between a bone and its parent's, where no third bone leaves the joint and the
  /// parent belongs to the same limb; else 0.
  [[nodiscard]] double bend_angle(int joint) const {
    const Joint& j = joints_[joint];
    if (j.parent < 0 || !j.tail || children_[j.parent].size() != 1) return 0;
    if (body_.in_plane(joints_[j.parent].head)) return 0;
    return angle_between(before(joint), bone_[joint]);
  }

  /// Where a straight bone turns to.
  [[nodiscard]] std::pair<Vector3d, std::string> goal(int joint) const {
    const bool hangs = body_.up.dot(bone_[joint]) < -0.7;
    if (hangs && reaches_ground(joint) && is_below_hip(joint)) {
      return {-body_.front, "backward, as a knee"};
    }
    return {body_.front, "forward"};
  }

  [[nodiscard]] bool reaches_ground(int joint) const {
    return body_.is_symmetric && lowest_[joint] <= body_.lowest + kFoot * body_.height;
  }

  /// Whether an ancestor of the same limb hangs as well.
  [[nodiscard]] bool is_below_hip(int joint) const {
    for (int p = joints_[joint].parent; p >= 0 && !body_.in_plane(joints_[p].head);
         p = joints_[p].parent) {
      if (body_.up.dot(bone_[p]) < -0.7) return true;
    }
    return false;
  }

  const std::vector<Joint>& joints_;
  std::vector<std::vector<int>> children_;
  Body body_;
  std::vector<Vector3d> bone_;
  std::vector<double> lowest_;  ///< of a joint and its descendants
};

/// An axis of the joint's own frame, turned to the side of `towards`.
GuessedAxis own_axis(const Eigen::Matrix3d& frame, int axis, const Vector3d& towards) {
  const double sign = frame.col(axis).dot(towards) >= 0 ? 1 : -1;
  const std::string name = std::string(sign > 0 ? "+" : "-") + "xyz"[axis];
  return {sign * frame.col(axis), "local " + name};
}

JointAxes axes_of(const Joint& joint, const Vector3d& bone, GuessedAxis guess) {
  JointAxes axes{std::move(guess), bone, {}};
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
