// Trees: branches hang on their parents, have lengths within bounds and do not cross. What the
// whole asks of each is in tree_plan.h, where there is room in tree_room.h.

#include "models/grammar/objects/tree.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "models/grammar/objects/crossing.h"
#include "solvers/grammar/rules/rules.h"
#include "solvers/grammar/rules/tree_plan.h"
#include "solvers/grammar/rules/tree_room.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using Branch = BranchParameter;

/// How far a branch follows a child that is pulled, over its length; the rest is its parent's.
constexpr double kCarrierYield = 0.35;

/// Whether a tag is on a branch or below it.
bool keeps_edit(const Hierarchy& h, int e) {
  const auto& children = h.children(e);
  return h.tag(e) != nullptr || std::any_of(children.begin(), children.end(), [&](int child) {
           return h.present(child) && keeps_edit(h, child);
         });
}

/// What the rules of trees know of the derivation that is under way.
class TreeGrammar {
 public:
  void tree_down(RuleCall& call);
  void branches_down(RuleCall& call);
  void branches_follow(RuleCall& call);
  void edited_up(RuleCall& call);
  void carrier_up(RuleCall& call);
  void tree_up(RuleCall& call);

 private:
  void prepare(const Hierarchy& h, const Vector3d& root);
  [[nodiscard]] Capsule planned_capsule(const Hierarchy& h, int e) const;
  void require_plan(const RuleCall& call) const;
  void ask_children(RuleCall& call, int parent);

  // Placing.
  void place_branch(RuleCall& call, int e);
  void place_fixed(RuleCall& call, int e);
  void subdivide(RuleCall& call, int e);
  void sprout(RuleCall& call, int parent, const BranchReach& s, int level, double mean,
              double radius);
  void sprout_aside(RuleCall& call, int e, double around);
  void change_children(RuleCall& call, int e);

  // Edits.
  void fix(const Hierarchy& h, int e, const Pose& pose, double length);
  void edit_parameter(RuleCall& call, int e);
  bool bounds_locality(const Hierarchy& h, int top);
  void pass_on(RuleCall& call, const Vector3d& shift);

  TreePlan plan_;
  TreeRoom room_;
  Vector3d tree_shift_ = Vector3d::Zero();
  int more_children_ = 0;  ///< of the edited branch
};

void TreeGrammar::require_plan(const RuleCall& call) const {
  if (plan_.derivation() != call.derivation())
    throw Error("is asked before its tree",
                "element '" + call.now().label(call.elements()[0]) + "'",
                "a deformation that the tree or a branch of it was asked for");
}

/// Of a branch whose place is a fact.
Capsule TreeGrammar::planned_capsule(const Hierarchy& h, int e) const {
  const BranchWish& wish = plan_.of(e);
  const Vector3d base = wish.pose.position;
  return {base, base + wish.length * (wish.pose.turn * Vector3d::UnitZ()),
          h.parameter(e, Branch::kRadius)};
}

void TreeGrammar::prepare(const Hierarchy& h, const Vector3d& root) {
  plan_.solve(h, root);
  room_.begin(plan_.tree(), plan_.mean_length(), static_cast<int>(plan_.branches().size()),
              h.size());
  for (const int e : plan_.branches()) {
    const BranchWish& wish = plan_.of(e);
    if (wish.moved && wish.follows) continue;
    const Capsule planned{wish.planned_base, wish.planned_base + wish.planned_along,
                          h.parameter(e, Branch::kRadius)};
    room_.place(e, wish.moved ? planned : branch_capsule(h, e), wish.moved && !wish.fixed);
  }
}

/// Asks the children that have to move or have to ask others, thick ones first: those take their
/// place before thin ones.
void TreeGrammar::ask_children(RuleCall& call, int parent) {
  const Hierarchy& h = call.now();
  std::vector<int> children;
  for (const int child : h.children(parent))
    if (h.present(child) && plan_.of(child).asked) children.push_back(child);
  if (children.empty()) return;
  std::stable_sort(children.begin(), children.end(), [&](int a, int b) {
    if (plan_.of(a).fixed != plan_.of(b).fixed) return plan_.of(a).fixed;
    return h.parameter(a, Branch::kRadius) > h.parameter(b, Branch::kRadius);
  });
  call.down(parent, std::move(children), call.delta());
}

void TreeGrammar::tree_down(RuleCall& call) {
  const int tree = call.elements()[0];
  const Pose before = call.pose_before(tree);
  if (call.origin() == Origin::child) {
    require_plan(call);
    call.set_pose(tree, {before.position + tree_shift_, before.turn});
    ask_children(call, tree);
    return;
  }
  std::shared_ptr<const SpatialMap> map = call.delta().map;
  switch (call.kind()) {
    case DeltaKind::free:
      break;
    case DeltaKind::rigid:
    case DeltaKind::affine:
    case DeltaKind::translate:
      map = std::make_shared<AffineMap>(call.transform(0));
      break;
    default:
      return;
  }
  plan_.begin(call.now(), tree, call.edited(), call.derivation());
  plan_.ask(call.now(), *map, tree);
  const MappedPoint at = map->with_jacobian(before.position);
  bool held = false;
  for (const int child : call.now().children(tree))
    held = held || (call.now().present(child) && plan_.of(child).held);
  // Where the base stays, so does the tree, bit for bit: what a map turns there is the branches'.
  if (!held && at.position != before.position)
    call.set_pose(tree, {at.position, (rotation_of(at.jacobian) * before.turn).normalized()});
  prepare(call.now(), call.now().position(tree));
  ask_children(call, tree);
}

void TreeGrammar::place_branch(RuleCall& call, int e) {
  const Hierarchy& h = call.now();
  const BranchWish& wish = plan_.of(e);
  const int parent = h.parent(e);
  const bool is_new = wish.sprouts;
  const Vector3d base = attach_point(h, parent, h.parameter(e, Branch::kAttach));
  const Eigen::Quaterniond carried = (wish.turn * h.turn(e)).normalized();
  const Vector3d along = plan_.best_along(e, base);
  const double wanted = along.norm();
  const BranchReach stretch{wanted > 1e-9 ? Vector3d(along / wanted) : carried * Vector3d::UnitZ(),
                            std::clamp(wanted, wish.low, wish.high)};
  if (parent != plan_.tree() &&
      h.parameter(parent, Branch::kRadius) < h.parameter(e, Branch::kRadius))
    call.set_parameter(e, Branch::kRadius, h.parameter(parent, Branch::kRadius));
  auto found = room_.find(h, e, base, stretch, wish.low);
  // A branch for which there is no room at all becomes thinner.
  for (int thinner = 0; !found && !is_new && thinner < 4; ++thinner) {
    call.set_parameter(e, Branch::kRadius, 0.5 * h.parameter(e, Branch::kRadius));
    found = room_.find(h, e, base, stretch, wish.low);
  }
  if (!found && is_new) {
    call.remove(e);
    return;
  }
  if (!found)
    throw Error("there is no room for the branch", "element '" + h.label(e) + "'",
                "a smaller deformation");
  call.set_pose(e, {base, turned_along(carried, found->direction)});
  call.set_parameter(e, Branch::kLength, found->length);
  room_.place(e, branch_capsule(h, e), false);
  if (!is_new) subdivide(call, e);
}

void TreeGrammar::place_fixed(RuleCall& call, int e) {
  const Hierarchy& h = call.now();
  const BranchWish& wish = plan_.of(e);
  call.set_pose(e, wish.pose);
  call.set_parameter(e, Branch::kLength, wish.length);
  room_.place(e, branch_capsule(h, e), false);
  subdivide(call, e);
  if (e == call.edited() && more_children_ != 0) change_children(call, e);
}

/// A branch that is asked to be longer than it may be goes on in a new one, beside which another
/// one leaves: as long as those of their levels may be at least, or as the deformation asks.
void TreeGrammar::subdivide(RuleCall& call, int e) {
  const Hierarchy& h = call.now();
  const BranchWish wish = plan_.of(e);
  const double longest = kLongestBranch * h.parameter(e, Branch::kMean);
  if ((wish.tip - wish.base).norm() <= longest * (1 + 1e-9) ||
      h.parameter(e, Branch::kLength) < longest * (1 - 1e-9))
    return;
  int at_tip = 0;
  for (const int child : h.children(e))
    at_tip += h.present(child) && h.parameter(child, Branch::kAttach) >= 1 - 1e-9;
  const Vector3d axis = branch_axis(h, e), tip = attach_point(h, e, 1);
  const double radius = h.parameter(e, Branch::kRadius) * h.parameter(e, Branch::kTaper);
  const double mean = h.parameter(e, Branch::kMean);
  const int level = static_cast<int>(h.parameter(e, Branch::kLevel));
  if (at_tip == 0) {
    const Vector3d rest = wish.tip - tip;
    const double length = rest.norm();
    const bool ahead = length > 1e-6 && rest.dot(axis) > 0.5 * length;
    sprout(call, e,
           {ahead ? Vector3d(rest / length) : axis,
            std::clamp(length, kShortestBranch * mean, kLongestBranch * mean)},
           level, mean, radius);
  }
  if (at_tip <= 1) sprout_aside(call, e, 0);
}

/// A short branch of the next level at the tip, 45 degrees off the axis.
/// @param around  angle about the axis (rad)
void TreeGrammar::sprout_aside(RuleCall& call, int e, double around) {
  const Hierarchy& h = call.now();
  const int level = static_cast<int>(h.parameter(e, Branch::kLevel)) + 1;
  const double mean = plan_.level_mean(level);
  const double radius = h.parameter(e, Branch::kRadius) * h.parameter(e, Branch::kTaper);
  const Vector3d aside = h.turn(e) * Vector3d(std::cos(around), std::sin(around), 0);
  sprout(call, e, {(branch_axis(h, e) + aside).normalized(), kShortestBranch * mean}, level, mean,
         0.7 * radius);
}

/// As many new branches at the tip as the edit asks for and as have room; or the thinnest ones go,
/// but for those that carry a user's edit.
void TreeGrammar::change_children(RuleCall& call, int e) {
  const Hierarchy& h = call.now();
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int k = 0; k < more_children_; ++k) sprout_aside(call, e, (k + 1) * golden);
  std::vector<int> children;
  for (const int child : h.children(e))
    if (h.present(child) && !keeps_edit(h, child)) children.push_back(child);
  std::stable_sort(children.begin(), children.end(), [&](int a, int b) {
    return h.parameter(a, Branch::kRadius) < h.parameter(b, Branch::kRadius);
  });
  for (int k = 0; k < std::min(-more_children_, static_cast<int>(children.size())); ++k)
    call.remove(children[k]);
}

void TreeGrammar::sprout(RuleCall& call, int parent, const BranchReach& s, int level, double mean,
                         double radius) {
  constexpr double kSproutTaper = 0.45;
  const Hierarchy& h = call.now();
  const double values[] = {s.length, radius, 1, static_cast<double>(level), mean, kSproutTaper};
  const Vector3d tip = attach_point(h, parent, 1);
  const int e = call.spawn(h.type_number(parent), parent,
                           {tip, turned_along(h.turn(parent), s.direction)}, values);
  BranchWish& wish = plan_.grow(e);
  wish.base = tip;
  wish.tip = tip + s.length * s.direction;
  wish.low = kShortestBranch * mean;
  wish.high = kLongestBranch * mean;
  wish.tip_pull = wish.tip;
  wish.sprouts = true;
}

void TreeGrammar::branches_down(RuleCall& call) {
  require_plan(call);
  for (const int e : call.elements()) {
    const BranchWish& wish = plan_.of(e);
    if (wish.fixed)
      place_fixed(call, e);
    else if (wish.moved)
      place_branch(call, e);
  }
  for (const int e : call.elements())
    if (call.now().present(e)) ask_children(call, e);
}

void TreeGrammar::branches_follow(RuleCall& call) {
  require_plan(call);
  const Hierarchy& h = call.now();
  for (std::size_t i = 0; i < call.elements().size(); ++i) {
    const int e = call.elements()[i];
    const Vector3d base = attach_point(h, h.parent(e), h.parameter(e, Branch::kAttach));
    const Eigen::Affine3d& motion = call.transform(i);
    Eigen::Quaterniond turn = h.turn(e);
    if (motion.matrix() != Eigen::Matrix4d::Identity())
      turn = (rotation_of(motion.linear()) * turn).normalized();
    const BranchReach wanted{turn * Vector3d::UnitZ(), h.parameter(e, Branch::kLength)};
    const auto found = room_.find(h, e, base, wanted, wanted.length);
    if (!found)
      throw Error("there is no room for the branch, whose length a tag keeps",
                  "element '" + h.label(e) + "'", "a smaller deformation");
    if (found->direction != wanted.direction) turn = turned_along(turn, found->direction);
    call.set_pose(e, {base, turn});
    room_.place(e, branch_capsule(h, e), false);
  }
  for (const int e : call.elements()) ask_children(call, e);
}

// ---- Edits of one branch -----------------------------------------------------------------------

void TreeGrammar::fix(const Hierarchy& h, int e, const Pose& pose, double length) {
  BranchWish& wish = plan_.of(e);
  if (wish.held)
    throw Error("carries a branch that a tag keeps where it is", "element '" + h.label(e) + "'",
                "an edit of what carries no such branch");
  wish.fixed = wish.moved = true;
  wish.pose = pose;
  wish.length = length;
  wish.base = pose.position;
  wish.tip = pose.position + length * (pose.turn * Vector3d::UnitZ());
}

void TreeGrammar::edit_parameter(RuleCall& call, int e) {
  const Hierarchy& h = call.now();
  const Delta& delta = call.delta();
  if (delta.parameter < 0 || delta.parameter > Branch::kTaper)
    throw Error("has no parameter " + std::to_string(delta.parameter),
                "element '" + h.label(e) + "'");
  const double old = h.parameter(e, delta.parameter);
  const double value = call.kind() == DeltaKind::extrude ? old + delta.value : delta.value;
  Pose pose = h.pose(e);
  BranchWish& wish = plan_.of(e);
  if (delta.parameter == Branch::kLength) {
    const double low = wish.low, high = 2 * wish.high;
    if (!(value >= low && value <= high))
      throw Error("the length would be " + std::to_string(value) + " m",
                  "element '" + h.label(e) + "'",
                  std::to_string(low) + " to " + std::to_string(high) + " m");
    fix(h, e, pose, std::min(value, wish.high));
    wish.tip = pose.position + value * (pose.turn * Vector3d::UnitZ());
    return;
  }
  if (delta.parameter == Branch::kLevel || delta.parameter == Branch::kMean)
    throw Error("the parameter is not to be edited", "element '" + h.label(e) + "'",
                "length, radius, attach, taper");
  call.set_parameter(e, delta.parameter, value);
  if (delta.parameter == Branch::kAttach) pose.position = attach_point(h, h.parent(e), value);
  fix(h, e, pose, h.parameter(e, Branch::kLength));
}

void TreeGrammar::edited_up(RuleCall& call) {
  const Hierarchy& h = call.now();
  const int e = call.elements()[0];
  plan_.begin(h, e, e, call.derivation());
  tree_shift_.setZero();
  more_children_ = 0;
  const Pose before = h.pose(e);
  const double length = h.parameter(e, Branch::kLength);
  Pose pose = before;
  BranchWish& wish = plan_.of(e);
  const auto bend = [&](const Vector3d& base, const Vector3d& tip, const Eigen::Matrix3d& linear) {
    const Vector3d along = tip - base;
    const double wanted = along.norm();
    if (!(wanted > 0 && wanted < 1e6))
      throw Error("the branch would have no length", "element '" + h.label(e) + "'");
    pose = {base, turned_along((rotation_of(linear) * before.turn).normalized(), along)};
    fix(h, e, pose, std::clamp(wanted, wish.low, wish.high));
    wish.tip = tip;
  };
  switch (call.kind()) {
    case DeltaKind::translate:
      pose.position += call.transform(0).translation();
      fix(h, e, pose, length);
      break;
    case DeltaKind::rigid:
      pose.position = call.transform(0) * before.position;
      pose.turn = (rotation_of(call.transform(0).linear()) * before.turn).normalized();
      fix(h, e, pose, length);
      break;
    case DeltaKind::affine: {
      const Eigen::Affine3d& t = call.transform(0);
      bend(t * wish.base, t * wish.tip, t.linear());
      break;
    }
    case DeltaKind::free: {
      const MappedPoint at = call.delta().map->with_jacobian(before.position);
      bend(at.position, call.delta().map->at(wish.tip), at.jacobian);
      plan_.ask(h, *call.delta().map, e);
      break;
    }
    case DeltaKind::extrude:
    case DeltaKind::set_parameter:
      edit_parameter(call, e);
      break;
    case DeltaKind::children:
      more_children_ = static_cast<int>(call.delta().value);
      fix(h, e, before, length);
      wish.moved = false;  // nor does what hangs on it
      break;
    default:
      return;
  }
  pass_on(call, call.kind() == DeltaKind::set_parameter || call.kind() == DeltaKind::extrude
                    ? Vector3d(Vector3d::Zero())
                    : Vector3d(pose.position - before.position));
}

/// The branch turns and lengthens so that the child's place on it moves by a shift, by as much as
/// suits it: its base moves by the rest, which its parent is asked for.
void TreeGrammar::carrier_up(RuleCall& call) {
  require_plan(call);
  const Hierarchy& h = call.now();
  const int e = call.elements()[0], child = call.sender();
  const Vector3d shift = call.delta().transform.translation();
  if (shift == Vector3d::Zero()) {
    pass_on(call, shift);
    return;
  }
  const double attach = h.parameter(child, Branch::kAttach),
               length = h.parameter(e, Branch::kLength);
  const Pose before = h.pose(e);
  const BranchWish& wish = plan_.of(e);
  const bool first = h.parent(e) == plan_.tree();
  const double size = shift.norm();
  Vector3d base_shift =
      first ? Vector3d(Vector3d::Zero())
            : Vector3d(std::max(0.0, 1 - kCarrierYield * length * attach / size) * shift);
  const Vector3d place = attach_point(h, e, attach) + shift;
  Vector3d along = (place - before.position - base_shift) / attach;
  const double wanted = along.norm(), allowed = std::clamp(wanted, wish.low, wish.high);
  if (wanted != allowed) {
    const Vector3d direction =
        wanted > 1e-9 ? Vector3d(along / wanted) : Vector3d(branch_axis(h, e));
    along = allowed * direction;
    base_shift = place - attach * along - before.position;
  }
  fix(h, e, {before.position + base_shift, turned_along(before.turn, along)}, allowed);
  pass_on(call, base_shift);
}

void TreeGrammar::tree_up(RuleCall& call) {
  if (call.origin() == Origin::user) {
    call.absorb(call.delta());
    return;
  }
  require_plan(call);
  tree_shift_ = call.delta().transform.translation();
  bounds_locality(call.now(), call.elements()[0]);
  call.absorb(call.delta());
}

void TreeGrammar::pass_on(RuleCall& call, const Vector3d& shift) {
  if (shift == Vector3d::Zero() && bounds_locality(call.now(), call.elements()[0]))
    call.absorb(call.delta());
  else
    call.up(Delta::translate(shift));
}

/// Whether nothing but what is below `top` has to move; if so, the plan is made.
///
/// What the edited branch and those that carry it would cross has to make room for them.
bool TreeGrammar::bounds_locality(const Hierarchy& h, int top) {
  plan_.carry(h);
  std::vector<int> facts;
  for (const int e : plan_.branches())
    if (plan_.of(e).fixed) facts.push_back(e);
  for (const int fact : facts) {
    const Capsule capsule = planned_capsule(h, fact);
    for (const int e : plan_.branches()) {
      BranchWish& other = plan_.of(e);
      if (e == fact || (other.moved && !other.fixed) || branches_meet(h, fact, e)) continue;
      const Capsule theirs = other.fixed ? planned_capsule(h, e) : branch_capsule(h, e);
      if (gap(capsule, theirs) >= kTreeClearance) continue;
      if (other.fixed || other.held || h.is_below(fact, e))
        throw Error("the edit would make it cross '" + h.label(e) + "'",
                    "element '" + h.label(fact) + "'", "an edit that leaves that one clear");
      other.moved = true;
    }
  }
  plan_.carry(h);
  const bool bounded = std::all_of(plan_.branches().begin(), plan_.branches().end(), [&](int e) {
    return top == plan_.tree() || !plan_.of(e).moved || h.is_below(e, top);
  });
  if (bounded) prepare(h, h.position(plan_.tree()) + tree_shift_);
  return bounded;
}

}  // namespace

RuleSet tree_rules() {
  RuleSet rules;
  const auto grammar = std::make_shared<TreeGrammar>();
  const auto add = [&](const char* name, const Guard& guard,
                       void (TreeGrammar::*apply)(RuleCall&)) {
    Rule rule;
    rule.name = name;
    rule.guard = guard;
    rule.apply = [grammar, apply](RuleCall& call) { ((*grammar).*apply)(call); };
    rules.add(std::move(rule));
  };
  Guard tree, branch, tagged;
  tree.type = "tree";
  branch.type = tagged.type = "branch";
  tagged.follows = true;
  tree.phase = branch.phase = tagged.phase = Phase::down;
  add("a tree stands where it is asked to", tree, &TreeGrammar::tree_down);
  add("a branch with a tag follows", tagged, &TreeGrammar::branches_follow);
  add("branches take their places", branch, &TreeGrammar::branches_down);
  tree.phase = branch.phase = Phase::up;
  add("a tree moves with what cannot stay", tree, &TreeGrammar::tree_up);
  branch.origin = Origin::user;
  add("an edited branch asks what carries it", branch, &TreeGrammar::edited_up);
  branch.origin = Origin::child;
  branch.kind = DeltaKind::translate;
  add("a branch carries a child to its place", branch, &TreeGrammar::carrier_up);
  rules.bound_locality("tree");
  return rules;
}

}  // namespace geoprior::grammar
