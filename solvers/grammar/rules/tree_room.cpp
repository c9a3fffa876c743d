#include "solvers/grammar/rules/tree_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "models/grammar/objects/tree.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using Branch = BranchParameter;

}  // namespace

void TreeRoom::begin(int tree, double mean_length, int branches, int elements) {
  tree_ = tree;
  grid_.restart(mean_length, branches);
  placed_.assign(elements, 0);
}

void TreeRoom::place(int branch, const Capsule& capsule, bool planned) {
  if (branch >= static_cast<int>(placed_.size())) placed_.resize(branch + 1, 0);
  // Most take the place that was planned for them, but for rounding.
  constexpr double kSame = 0.01 * kTreeClearance;
  const Capsule* old = grid_.of(branch);
  if (old == nullptr || old->radius != capsule.radius ||
      (old->a - capsule.a).cwiseAbs().maxCoeff() > kSame ||
      (old->b - capsule.b).cwiseAbs().maxCoeff() > kSame)
    grid_.place(branch, capsule);
  placed_[branch] = !planned;
}

/// What a branch would cross the deepest in a place.
///
/// Branches that meet in a node do not count, but the children of the one have to be clear of the
/// other where they begin: however they turn, they could not leave it.
std::optional<Crossing> TreeRoom::worst(const Hierarchy& h, int e, const Capsule& capsule,
                                        Way way) const {
  const int parent = h.parent(e);
  const double radius = h.parameter(e, Branch::kRadius), attach = h.parameter(e, Branch::kAttach);
  const auto absent = [&](int other) {
    if (placed_[other]) return false;
    if (way == Way::placed) return true;
    const double theirs = h.parameter(other, Branch::kRadius);
    return theirs < radius || (theirs == radius && other > e);
  };
  const auto at_node = [&](int other) {
    return h.parent(other) == parent &&
           std::abs(h.parameter(other, Branch::kAttach) - attach) <= 1e-9;
  };
  auto out = grid_.deepest(capsule, kTreeClearance, [&](int other) {
    return other == e || other == parent || h.parent(other) == e || at_node(other) || absent(other);
  });
  const auto start_of = [&](int child, const Capsule& on) {
    const Vector3d x = on.a + h.parameter(child, Branch::kAttach) * (on.b - on.a);
    return Capsule{x, x, h.parameter(child, Branch::kRadius) + kTreeClearance};
  };
  const auto keep_clear = [&](int other) {
    const Capsule* theirs = grid_.of(other);
    if (theirs == nullptr || absent(other)) return;
    for (const int child : h.children(e))
      if (h.present(child)) CapsuleGrid::take_deeper(start_of(child, capsule), *theirs, other, out);
    if (other == parent) return;
    for (const int child : h.children(other))
      if (h.present(child)) CapsuleGrid::take_deeper(capsule, start_of(child, *theirs), other, out);
  };
  if (parent == tree_) return out;
  keep_clear(parent);
  for (const int other : h.children(parent))
    if (other != e && h.present(other) && at_node(other)) keep_clear(other);
  return out;
}

/// Turns a branch about its base, or shortens it, away from what it crosses, one after the other.
std::optional<BranchReach> TreeRoom::push_clear(const Hierarchy& h, int e, const Vector3d& base,
                                                BranchReach s, double low, Way way) const {
  constexpr int kPushes = 8;
  const double radius = h.parameter(e, Branch::kRadius);
  const Vector3d wanted = s.direction;
  for (int push = 0; push <= kPushes; ++push) {
    const auto crossing = worst(h, e, {base, base + s.length * s.direction, radius}, way);
    if (!crossing) return s;
    const double along = (crossing->at - base).dot(s.direction);
    const double ahead = crossing->away.dot(s.direction);
    const Vector3d aside = crossing->away - ahead * s.direction;
    const double depth = crossing->depth + 2 * kTreeClearance, side = aside.norm();
    if (side > 0.4 && along > 0.02 * s.length) {
      s.direction = (along * s.direction + (depth / (side * side)) * aside).normalized();
    } else if (ahead < -0.4 && along + depth / ahead >= low) {
      s.length = along + depth / ahead;
    } else {
      return std::nullopt;
    }
    if (s.direction.dot(wanted) < 0.7) return std::nullopt;
  }
  return std::nullopt;
}

/// The nearest of fixed directions about the wanted one that is free, then with a shorter branch.
std::optional<BranchReach> TreeRoom::fan_out(const Hierarchy& h, int e, const Vector3d& base,
                                             const BranchReach& s, double low, Way way) const {
  constexpr int kRays = 10;
  constexpr double kDegree = std::numbers::pi / 180;
  constexpr std::array kNear{8.0, 16.0, 26.0, 38.0, 52.0}, kFar{68.0, 86.0, 106.0, 130.0, 155.0};
  const double radius = h.parameter(e, Branch::kRadius);
  const Vector3d x = (turned_along(h.turn(e), s.direction) * Vector3d::UnitX());
  const Vector3d y = s.direction.cross(x);
  const auto try_rings = [&](const auto& rings, double length) -> std::optional<BranchReach> {
    for (const double ring : rings)
      for (int ray = 0; ray < kRays; ++ray) {
        const double angle = ring * kDegree, around = 2 * std::numbers::pi * ray / kRays;
        const Vector3d d = std::cos(angle) * s.direction +
                           std::sin(angle) * (std::cos(around) * x + std::sin(around) * y);
        if (!worst(h, e, {base, base + length * d, radius}, way)) return BranchReach{d, length};
      }
    return std::nullopt;
  };
  for (const double share : {0.0, 0.4, 1.0}) {
    const double length = s.length + share * (low - s.length);
    if (share > 0 && low >= s.length) break;
    if (share > 0 && !worst(h, e, {base, base + length * s.direction, radius}, way))
      return BranchReach{s.direction, length};
    if (auto found = try_rings(kNear, length)) return found;
  }
  if (way == Way::all) return std::nullopt;
  return try_rings(kFar, std::min(low, s.length));
}

std::optional<BranchReach> TreeRoom::find(const Hierarchy& h, int e, const Vector3d& base,
                                          const BranchReach& s, double low) const {
  for (const Way way : {Way::all, Way::placed}) {
    if (auto found = push_clear(h, e, base, s, low, way)) return found;
    if (auto found = fan_out(h, e, base, s, low, way)) return found;
  }
  return std::nullopt;
}

}  // namespace geoprior::grammar
