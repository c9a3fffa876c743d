#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "experiments/grammar/measures/violations.h"
#include "solvers/grammar/engine/rule.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

constexpr int kCorners = 8;

/// Corner 0 and the edges from it, of the eight corners of a box: four around the bottom, then four
/// around the top.
struct PartBox {
  Vector3d corner;
  std::array<Vector3d, 3> edge;
  Vector3d middle;
};

PartBox box_of_corners(const std::vector<Vector3d>& keys) {
  PartBox box{keys[0], {keys[1] - keys[0], keys[3] - keys[0], keys[4] - keys[0]}, Vector3d::Zero()};
  for (const Vector3d& x : keys) box.middle += x / kCorners;
  return box;
}

double angle_deg(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

void add_shape(const std::vector<Vector3d>& keys, const PartBox& now, const PartBox& rest,
               bool stretches, int number, Tally& shape) {
  double worst = 0;
  for (int k = 0; k < kCorners; ++k) {
    Vector3d x = now.corner;
    if (k % 4 == 1 || k % 4 == 2) x += now.edge[0];
    if (k % 4 >= 2) x += now.edge[1];
    if (k >= 4) x += now.edge[2];
    worst = std::max(worst, (x - keys[k]).norm());
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double length = now.edge[axis].norm();
    if (!stretches) worst = std::max(worst, std::abs(length - rest.edge[axis].norm()));
    // Two edges are at a right angle: the way along the other, in m.
    const double other = now.edge[(axis + 1) % 3].norm();
    if (length > 0 && other > 0)
      worst = std::max(
          worst, std::abs(now.edge[axis].dot(now.edge[(axis + 1) % 3])) / std::max(length, other));
  }
  shape.add(worst, {number});
}

void add_turn(const PartBox& now, const PartBox& rest, int number, Tally& turn) {
  for (int axis = 0; axis < 3; ++axis)
    if (rest.edge[axis].norm() > 0) turn.add(angle_deg(rest.edge[axis], now.edge[axis]), {number});
}

/// The part of a shift across an axis, or along it.
double strayed(const Vector3d& shift, const Vector3d& edge, bool along) {
  if (!(edge.norm() > 0)) return 0;
  const Vector3d axis = edge.normalized();
  const double way = shift.dot(axis);
  return along ? std::abs(way) : (shift - way * axis).norm();
}

}  // namespace

MachineViolations machine_violations(const RecordedState& state, const RecordedState& rest,
                                     bool imported) {
  MachineViolations out;
  if (!imported) return out;
  struct Link {
    int number;
    Vector3d middle, at_rest;
  };
  std::map<int, Link> link_before;  // by parent
  for (const RecordedElement& element : state.elements()) {
    const RecordedElement* was = rest.find_same(element);
    if (was == nullptr || element.keys.size() != kCorners) continue;
    const auto is = [&](const char* pattern) { return matches(pattern, state.type_name(element)); };
    const PartBox now = box_of_corners(element.keys), before = box_of_corners(was->keys);
    const Vector3d shift = now.middle - before.middle;
    const int number = element.number;
    add_shape(element.keys, now, before, is("body*"), number, out.shape);
    if (is("body*") || is("Piston*") || is("Lifter*")) add_turn(now, before, number, out.turn);
    if (is("Piston*")) out.slide.add(strayed(shift, before.edge[0], false), {number});
    if (is("Lifter*")) out.slide.add(strayed(shift, before.edge[1], false), {number});
    if (is("rod*")) out.slide.add(strayed(shift, before.edge[1], true), {number});
    if (!is("Spring_Link*")) continue;
    if (const auto last = link_before.find(element.parent); last != link_before.end())
      out.links.add(std::abs((now.middle - last->second.middle).norm() -
                             (before.middle - last->second.at_rest).norm()),
                    {last->second.number, number});
    link_before.insert_or_assign(element.parent, Link{number, now.middle, before.middle});
  }
  return out;
}

}  // namespace geoprior::grammar
