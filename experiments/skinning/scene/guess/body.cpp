#include "experiments/skinning/scene/guess/body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "experiments/skinning/scene/guess/hand.h"

namespace geoprior::skinning {
namespace {

using Eigen::Vector3d;

constexpr double kReach = 0.25;       ///< of all limbs downwards, over the size; less shows no up
constexpr double kUpright = 0.87;     ///< cosine of 30 degrees between limbs or trunk and an axis
constexpr double kAlongTrunk = 0.5;   ///< cosine between what limbs and trunk show of up
constexpr double kFootLength = 0.04;  ///< of all feet forward, over the height; less shows no front

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

/// Finds the plane of symmetry; returns the axis across it.
int find_sides(const Skeleton& skeleton, Body& body) {
  int most = 0;
  int sides = 0;
  for (const int axis : {0, 2, 1}) {
    const int count = mirrored_joints(skeleton, axis, median(skeleton, axis), body.tolerance);
    if (count > most) sides = axis;
    most = std::max(most, count);
  }
  body.middle = median(skeleton, sides);
  const auto off_plane =
      std::count_if(skeleton.joints.begin(), skeleton.joints.end(), [&](const Joint& joint) {
        return std::abs(joint.head[sides] - body.middle) > body.tolerance;
      });
  // A third of the joints that lie off the plane, and two pairs: one may be an accident.
  body.is_symmetric = most >= 4 && 3 * most >= off_plane;
  return sides;
}

/// For each joint the root of the limb that it belongs to; -1 in the plane of symmetry.
std::vector<int> limb_roots(const Skeleton& skeleton, const Body& body) {
  std::vector<int> roots;
  for (int j = 0; j < skeleton.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    if (body.in_plane(joint.head)) {
      roots.push_back(-1);
    } else {
      const int above = joint.parent < 0 ? -1 : roots[joint.parent];
      roots.push_back(above < 0 ? j : above);
    }
  }
  return roots;
}

/// From the root of every limb to the joint of it that is farthest; of a lone joint nothing.
std::vector<Vector3d> limb_vectors(const Skeleton& skeleton, const std::vector<int>& roots) {
  std::vector<Vector3d> vectors(skeleton.joints.size(), Vector3d::Zero());
  for (int j = 0; j < skeleton.size(); ++j) {
    if (roots[j] < 0) continue;
    const Vector3d reach = skeleton.joints[j].head - skeleton.joints[roots[j]].head;
    if (reach.norm() > vectors[roots[j]].norm()) vectors[roots[j]] = reach;
  }
  return vectors;
}

/// The axis, with its sign, that is next to a direction in the plane of symmetry; absent where
/// none is within 30 degrees.
std::optional<Vector3d> near_axis(Vector3d direction, int sides) {
  direction[sides] = 0;
  int axis = 0;
  const double most = direction.cwiseAbs().maxCoeff(&axis);
  if (!(most > kUpright * direction.norm())) return std::nullopt;
  return Vector3d(std::copysign(1.0, direction[axis]) * Vector3d::Unit(axis));
}

/// From the first joint in the plane of symmetry to the farthest that hangs on it there.
Vector3d trunk(const Skeleton& skeleton, const std::vector<int>& roots) {
  const auto first = std::find(roots.begin(), roots.end(), -1) - roots.begin();
  Vector3d farthest = Vector3d::Zero();
  for (std::size_t j = first; j < roots.size(); ++j) {
    const Vector3d reach = skeleton.joints[j].head - skeleton.joints[first].head;
    if (roots[j] < 0 && reach.norm() > farthest.norm()) farthest = reach;
  }
  return farthest;
}

void find_up(const Skeleton& skeleton, int sides, Body& body) {
  const std::vector<int> roots = limb_roots(skeleton, body);
  Vector3d down = Vector3d::Zero();
  for (const Vector3d& limb : limb_vectors(skeleton, roots)) down += limb;
  down[sides] = 0;
  body.up = sides == 1 ? Vector3d::UnitZ() : Vector3d::UnitY();
  const bool reaches_down = down.norm() >= kReach * body.size;
  const auto by_limbs = near_axis(-down, sides);
  const auto by_trunk = near_axis(trunk(skeleton, roots), sides);
  if (reaches_down && by_limbs) {
    body.up = *by_limbs;
  } else if (reaches_down && by_trunk && -down.dot(*by_trunk) > kAlongTrunk * down.norm()) {
    body.up = *by_trunk;  // of one that sits, or stretches its arms forward
  } else if (by_trunk != body.up) {
    body.up_doubt = "no legs show which way is up";
  }
}

/// Sum over the lowest bones beside the plane (feet) of what they reach along an axis.
double feet_along(const Vector3d& axis, const Skeleton& skeleton, const Body& body) {
  double sum = 0;
  for (const Joint& joint : skeleton.joints) {
    if (joint.tail && body.is_at_ground(joint.head) && !body.in_plane(joint.head))
      sum += axis.dot(*joint.tail - joint.head);
  }
  return sum;
}

int count_legs(const Skeleton& skeleton, const Body& body) {
  const std::vector<int> roots = limb_roots(skeleton, body);
  std::vector<bool> is_leg(roots.size(), false);
  for (int j = 0; j < skeleton.size(); ++j) {
    if (roots[j] >= 0 && body.is_at_ground(skeleton.joints[j].head)) is_leg[roots[j]] = true;
  }
  return static_cast<int>(std::count(is_leg.begin(), is_leg.end(), true));
}

void find_front(const Skeleton& skeleton, int sides, Body& body) {
  double highest = -std::numeric_limits<double>::infinity();
  body.lowest = -highest;
  for (const Joint& joint : skeleton.joints) {
    highest = std::max(highest, body.up.dot(joint.head));
    body.lowest = std::min(body.lowest, body.up.dot(joint.head));
  }
  body.height = highest - body.lowest;
  body.front = body.up.cross(Vector3d::Unit(sides)).cwiseAbs();
  const double feet = feet_along(body.front, skeleton, body);
  if (feet < 0) body.front = -body.front;
  if (std::abs(feet) < kFootLength * body.height)
    body.front_doubt = "no feet show where the front is";
}

/// Whether all joints are one hand, or an arm that ends in it: such a hand may have mirror images
/// of its own, across the middle finger.
bool is_hand(const Skeleton& skeleton) {
  const auto children = skeleton.children();
  const std::vector<int> arm = chain_from(0, children);
  const Joint& end = skeleton.joints[arm.back()];
  const Vector3d bone = (end.tail.value_or(end.head) - end.head).stableNormalized();
  if (!find_hand(skeleton, children, arm.back(), bone)) return false;
  std::size_t joints = arm.size();
  for (const int finger : children[arm.back()]) joints += chain_from(finger, children).size();
  return joints == skeleton.joints.size();
}

}  // namespace

Body find_body(const Skeleton& skeleton) {
  Eigen::AlignedBox3d box;
  for (const Joint& joint : skeleton.joints) box.extend(joint.head);
  Body body;
  body.size = box.diagonal().norm();
  body.tolerance = 0.02 * body.size;
  if (is_hand(skeleton)) {
    body.up_doubt = body.front_doubt = "a hand alone shows no front";
    return body;
  }
  const int sides = find_sides(skeleton, body);
  if (!body.is_symmetric) {
    body.middle = 0;
    body.up_doubt = body.front_doubt = "no mirror images of joints show how the body stands";
    return body;
  }
  body.left = Vector3d::Unit(sides);  // for what lies in the plane; its sign comes with the front
  find_up(skeleton, sides, body);
  find_front(skeleton, sides, body);
  body.left = body.up.cross(body.front);
  body.middle *= body.left[sides];
  body.legs = count_legs(skeleton, body);
  return body;
}

}  // namespace geoprior::skinning
