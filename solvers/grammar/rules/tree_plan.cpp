#include "solvers/grammar/rules/tree_plan.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.h"
#include "models/grammar/objects/tree.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

constexpr int kPlanPasses = 12;
constexpr double kSettled = 1e-9;        // m, between two passes
constexpr double kFarthestBranch = 1e6;  // m

/// Weight, centre and best tip of a branch, from the sums over its children.
void weigh_branch(BranchWish& wish, const BranchSums& below) {
  const double share = below.wa - below.waa;
  wish.tip_weight = 1 + below.waa;
  wish.tip_share = share;
  wish.tip_pull = wish.tip + below.wax;
  if (wish.clamped) {
    wish.weight = 2 + below.w;
    wish.centre =
        (wish.base + wish.tip - wish.planned_along + below.wx - below.wa * wish.planned_along) /
        wish.weight;
    return;
  }
  wish.weight = 1 + below.w - 2 * below.wa + below.waa - share * share / wish.tip_weight;
  wish.centre =
      (wish.base + below.wx - below.wax - (share / wish.tip_weight) * wish.tip_pull) / wish.weight;
}

}  // namespace

void TreePlan::begin(const Hierarchy& hierarchy, int element, int edited,
                     std::uint64_t derivation) {
  derivation_ = derivation;
  const int tree_kind = hierarchy.find_type("tree"), branch_kind = hierarchy.find_type("branch");
  for (tree_ = element; tree_ >= 0 && hierarchy.type_number(tree_) != tree_kind;)
    tree_ = hierarchy.parent(tree_);
  if (tree_ < 0) throw Error("is of no tree", "element '" + hierarchy.label(element) + "'");
  branches_.clear();
  std::vector<int> open{tree_};
  while (!open.empty()) {
    const int above = open.back();
    open.pop_back();
    for (const int child : hierarchy.children(above)) {
      if (!hierarchy.present(child) || hierarchy.type_number(child) != branch_kind) continue;
      branches_.push_back(child);
      open.push_back(child);
    }
  }
  std::sort(branches_.begin(), branches_.end());
  wishes_.assign(hierarchy.size(), {});
  mapped_.assign(hierarchy.size(), 0);
  means_.clear();
  mean_length_ = 0;
  for (const int e : branches_) {
    limits(hierarchy, e);
    BranchWish& wish = wishes_[e];
    const Tag* tag = hierarchy.tag(e);
    if (tag != nullptr && hierarchy.is_below(edited, e)) tag = nullptr;
    const int parent = hierarchy.parent(e);
    const bool below = parent != tree_;
    wish.follows =
        (below && wishes_[parent].follows) || (tag != nullptr && tag->follow == Tag::Follow::rigid);
    wish.held =
        (below && wishes_[parent].held) || (tag != nullptr && tag->follow == Tag::Follow::stop);
  }
  // What carries a branch that stays has to stay; what else hangs on that is free.
  for (auto e = branches_.rbegin(); e != branches_.rend(); ++e)
    if (const int parent = hierarchy.parent(*e); parent != tree_ && wishes_[*e].held)
      wishes_[parent].held = true;
}

void TreePlan::limits(const Hierarchy& hierarchy, int e) {
  using Branch = BranchParameter;
  BranchWish& wish = wishes_[e];
  const double length = hierarchy.parameter(e, Branch::kLength),
               mean = hierarchy.parameter(e, Branch::kMean);
  wish.base = wish.planned_base = hierarchy.position(e);
  wish.planned_along = length * branch_axis(hierarchy, e);
  wish.tip = wish.base + wish.planned_along;
  wish.low = kShortestBranch * mean;
  wish.high = kLongestBranch * mean;
  // Children that hang on different places keep apart, and from what the branch hangs on, however
  // short it becomes.
  const auto keep_apart = [&](double attach, double radii) {
    if (attach > 1e-9) wish.low = std::max(wish.low, std::min((radii + 1e-6) / attach, length));
  };
  const auto radius = [&](int branch) { return hierarchy.parameter(branch, Branch::kRadius); };
  const auto attach = [&](int branch) { return hierarchy.parameter(branch, Branch::kAttach); };
  const int parent = hierarchy.parent(e);
  for (const int a : hierarchy.children(e)) {
    if (!hierarchy.present(a)) continue;
    if (parent != tree_) keep_apart(attach(a), radius(a) + radius(parent));
    for (const int b : hierarchy.children(e))
      if (b < a && hierarchy.present(b))
        keep_apart(std::abs(attach(a) - attach(b)), radius(a) + radius(b));
  }
  const auto level = static_cast<std::size_t>(hierarchy.parameter(e, Branch::kLevel));
  if (level >= means_.size()) means_.resize(level + 1, 0);
  means_[level] = mean;
  mean_length_ += length / static_cast<double>(branches_.size());
}

double TreePlan::level_mean(int level) const {
  level = std::min(level, static_cast<int>(means_.size()) - 1);
  while (level > 0 && means_[level] == 0) --level;
  return means_[level];
}

void TreePlan::ask(const Hierarchy& hierarchy, const SpatialMap& map, int top) {
  for (const int e : branches_) {
    const int parent = hierarchy.parent(e);
    if (parent != top && !(parent != tree_ && mapped_[parent])) continue;
    mapped_[e] = 1;
    BranchWish& wish = wishes_[e];
    if (wish.held) continue;
    const bool carried = parent == tree_ ? top != tree_ : wishes_[parent].moved;
    const Vector3d base = wish.base, tip = wish.tip;
    Eigen::AlignedBox3d box(base);
    box.extend(tip);
    if (reaches(map, box)) {
      const MappedPoint image = map.with_jacobian(base);
      wish.base = image.position;
      wish.tip = map.at(tip);
      const double size = wish.base.cwiseAbs().maxCoeff() + wish.tip.cwiseAbs().maxCoeff();
      if (!(size < kFarthestBranch) || !image.jacobian.allFinite())
        throw Error("is taken to no finite place by the map",
                    "element '" + hierarchy.label(e) + "'", "images within 1000 km");
      if (image.jacobian != Eigen::Matrix3d::Identity()) wish.turn = rotation_of(image.jacobian);
    }
    wish.moved = carried || (!wish.follows && (wish.base != base || wish.tip != tip));
  }
}

void TreePlan::carry(const Hierarchy& hierarchy) {
  for (const int e : branches_) {
    BranchWish& wish = wishes_[e];
    const int parent = hierarchy.parent(e);
    if (wish.fixed || wish.held || mapped_[e] || parent == tree_) continue;
    const BranchWish& above = wishes_[parent];
    if (!above.moved) continue;
    wish.moved = true;
    wish.turn = above.fixed ? (above.pose.turn * hierarchy.turn(parent).conjugate()).normalized()
                            : above.turn;
    const Vector3d along = above.fixed
                               ? Vector3d(above.length * (above.pose.turn * Vector3d::UnitZ()))
                               : Vector3d(above.tip - above.base);
    const Vector3d base = above.fixed ? above.pose.position : above.base;
    wish.base = base + hierarchy.parameter(e, BranchParameter::kAttach) * along;
    wish.tip = wish.base + wish.turn * (hierarchy.parameter(e, BranchParameter::kLength) *
                                        branch_axis(hierarchy, e));
  }
}

void TreePlan::pass_up(const Hierarchy& hierarchy) {
  sums_.assign(wishes_.size(), {});
  for (auto i = branches_.rbegin(); i != branches_.rend(); ++i) {
    const int e = *i, parent = hierarchy.parent(e);
    BranchWish& wish = wishes_[e];
    if (!wish.moved) continue;
    if (wish.follows) {
      wish.weight = 1;
      wish.centre = wish.base;
    } else {
      weigh_branch(wish, sums_[e]);
    }
    if (parent != tree_ && !wish.fixed)
      sums_[parent].add(wish.weight, hierarchy.parameter(e, BranchParameter::kAttach), wish.centre);
  }
}

double TreePlan::pass_down(const Hierarchy& hierarchy, const Vector3d& root) {
  double turned = 0;
  for (const int e : branches_) {
    BranchWish& wish = wishes_[e];
    if (!wish.moved) continue;
    if (wish.fixed) {
      wish.planned_base = wish.pose.position;
      wish.planned_along = wish.length * (wish.pose.turn * Vector3d::UnitZ());
      continue;
    }
    const int parent = hierarchy.parent(e);
    const BranchWish& above = wishes_[parent == tree_ ? e : parent];
    wish.planned_base =
        parent == tree_
            ? root
            : Vector3d(above.planned_base +
                       hierarchy.parameter(e, BranchParameter::kAttach) * above.planned_along);
    if (wish.follows) continue;
    const Vector3d along = best_along(e, wish.planned_base);
    const double length = along.norm(), allowed = std::clamp(length, wish.low, wish.high);
    const bool clamped = std::exchange(wish.clamped, length != allowed);
    if (!(length > 0)) continue;
    const Vector3d before = std::exchange(wish.planned_along, (allowed / length) * along);
    // What is not clamped has no say in the next pass.
    if (clamped || wish.clamped)
      turned = std::max(turned, (wish.planned_along - before).cwiseAbs().maxCoeff());
  }
  return turned;
}

void TreePlan::solve(const Hierarchy& hierarchy, const Vector3d& root) {
  for (int pass = 0; pass < kPlanPasses; ++pass) {
    pass_up(hierarchy);
    if (pass_down(hierarchy, root) <= kSettled) break;
  }
  for (const int e : branches_) wishes_[e].asked = wishes_[e].moved;
  for (auto e = branches_.rbegin(); e != branches_.rend(); ++e)
    if (const int parent = hierarchy.parent(*e); parent != tree_ && wishes_[*e].asked)
      wishes_[parent].asked = true;
}

Vector3d TreePlan::best_along(int branch, const Vector3d& base) const {
  const BranchWish& wish = wishes_[branch];
  return (wish.tip_pull - wish.tip_share * base) / wish.tip_weight - base;
}

BranchWish& TreePlan::grow(int branch) {
  if (branch >= static_cast<int>(wishes_.size())) wishes_.resize(branch + 1);
  wishes_[branch].moved = wishes_[branch].asked = true;
  return wishes_[branch];
}

}  // namespace geoprior::grammar
